// SPDX-License-Identifier: LGPL-2.1-or-later
#include <alveolus/assembly/contact_multipliers.h>

namespace alveolus
{
  using namespace dealii;

  void
  ContactMultipliers::set(const unsigned int chain, std::vector<Sample> samples)
  {
    constexpr double same_place = 1e-12;
    std::stable_sort(samples.begin(),
                     samples.end(),
                     [](const Sample &a, const Sample &b) {
                       return a.first < b.first;
                     });
    if (functions.size() <= chain)
      functions.resize(chain + 1);
    auto &function = functions[chain];
    function.clear();
    for (std::size_t i = 0; i < samples.size();)
      {
        Sample       mean{samples[i].first, Value()};
        unsigned int n = 0;
        for (;
             i < samples.size() && samples[i].first - mean.first <= same_place;
             ++i, ++n)
          {
            mean.second.pressure += samples[i].second.pressure;
            mean.second.shear += samples[i].second.shear;
            mean.second.slip += samples[i].second.slip;
            mean.second.touching += samples[i].second.touching;
          }
        mean.second.pressure /= n;
        mean.second.shear /= n;
        mean.second.slip /= n;
        mean.second.touching /= n;
        function.push_back(mean);
      }
  }



  ContactMultipliers::Value
  ContactMultipliers::get(const unsigned int chain,
                          const double       arc_length) const
  {
    if (chain >= functions.size() || functions[chain].empty())
      return Value();
    const auto &function = functions[chain];
    const auto  after    = std::lower_bound(function.begin(),
                                        function.end(),
                                        arc_length,
                                        [](const Sample &a, const double s) {
                                          return a.first < s;
                                        });
    if (after == function.begin())
      return function.front().second;
    if (after == function.end())
      return function.back().second;
    const Sample &a = *(after - 1), &b = *after;
    const double  part = (arc_length - a.first) / (b.first - a.first);
    Value         value;
    value.pressure = (1. - part) * a.second.pressure + part * b.second.pressure;
    value.shear    = (1. - part) * a.second.shear + part * b.second.shear;
    value.slip     = (1. - part) * a.second.slip + part * b.second.slip;
    value.touching = (1. - part) * a.second.touching + part * b.second.touching;
    return value;
  }



  void
  ContactMultipliers::forget_closed(const ContactOutline &outline)
  {
    for (unsigned int c = 0; c < outline.chains.size() && c < functions.size();
         ++c)
      if (outline.chains[c].closed)
        functions[c].clear();
  }



  void
  ContactMultipliers::save(const std::string &prefix, BlockFile &blocks) const
  {
    BlockFile::Integers sizes;
    BlockFile::Numbers  values;
    for (const auto &function : functions)
      {
        sizes.push_back(function.size());
        for (const auto &[place, value] : function)
          values.insert(
            values.end(),
            {place, value.pressure, value.shear, value.slip, value.touching});
      }
    blocks.put(prefix + "multipliers per chain", std::move(sizes));
    blocks.put(prefix + "multipliers", std::move(values));
  }



  void
  ContactMultipliers::load(const std::string &prefix, const BlockFile &blocks)
  {
    const auto &sizes  = blocks.integers(prefix + "multipliers per chain");
    const auto &values = blocks.numbers(prefix + "multipliers");
    functions.clear();
    std::size_t next = 0;
    for (const auto size : sizes)
      {
        if (size > (values.size() - next) / 5)
          blocks.refuse(prefix + "multipliers",
                        "is shorter than its chains need");
        functions.emplace_back();
        for (std::size_t i = 0; i < size; ++i, next += 5)
          functions.back().emplace_back(values[next],
                                        Value{values[next + 1],
                                              values[next + 2],
                                              values[next + 3],
                                              values[next + 4]});
      }
  }



  ContactMultiplierSpace::ContactMultiplierSpace(const ContactOutline &outline,
                                                 const std::vector<bool> &used)
    : indices(outline.n_edges(), {{no_edge, no_edge}})
  {
    // Ascending along each chain; a closed one is cut where it begins.
    for (const auto &chain : outline.chains)
      for (unsigned int e = chain.first; e < chain.first + chain.n_edges; ++e)
        if (used[e])
          {
            const bool goes_on = e > chain.first && used[e - 1];
            indices[e][0]      = goes_on ? indices[e - 1][1] : n++;
            indices[e][1]      = n++;
          }
  }



  std::vector<double>
  ContactMultiplierSpace::project(const std::vector<Sample> &samples) const
  {
    // Normal equations; the matrix is tridiagonal.
    std::vector<double> diagonal(n, 0.), upper(n, 0.), x(n, 0.);
    for (const Sample &sample : samples)
      {
        const unsigned int i = indices[sample.edge][0];
        const double       a = 1. - sample.xi, b = sample.xi;
        diagonal[i] += sample.weight * a * a;
        diagonal[i + 1] += sample.weight * b * b;
        upper[i] += sample.weight * a * b;
        x[i] += sample.weight * a * sample.value;
        x[i + 1] += sample.weight * b * sample.value;
      }
    for (unsigned int i = 1; i < n; ++i)
      {
        const double factor = upper[i - 1] / diagonal[i - 1];
        diagonal[i] -= factor * upper[i - 1];
        x[i] -= factor * x[i - 1];
      }
    for (unsigned int i = n; i-- > 0;)
      x[i] = (x[i] - (i + 1 < n ? upper[i] * x[i + 1] : 0.)) / diagonal[i];
    return x;
  }



  ContactArcLength::ContactArcLength(const ContactOutline        &outline,
                                     const std::vector<Point<2>> &positions)
    : outline(outline)
    , chain(outline.n_edges())
    , before(outline.n_edges())
  {
    for (unsigned int c = 0; c < outline.chains.size(); ++c)
      {
        double length = 0.;
        for (unsigned int e = outline.chains[c].first;
             e < outline.chains[c].first + outline.chains[c].n_edges;
             ++e)
          {
            curves.push_back(outline.curve(e, positions));
            chain[e]  = c;
            before[e] = length;
            length += curves[e].length();
          }
        total.push_back(length);
      }
  }



  double
  ContactArcLength::operator()(const unsigned int edge, const double xi) const
  {
    return (before[edge] + curves[edge].length(0., xi)) / total[chain[edge]];
  }
} // namespace alveolus
