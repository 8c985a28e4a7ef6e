// SPDX-License-Identifier: LGPL-2.1-or-later
#include <alveolus/rezoning/anchored_curve.h>

namespace alveolus
{
  AnchoredCurve::AnchoredCurve(const NodeCurve        &curve,
                               const std::set<NodeId> &taken)
    : curve(curve)
  {
    const int        n = curve.nodes.size();
    std::vector<int> anchors;
    for (int i = 0; i < n; ++i)
      if (taken.count(curve.nodes[i]) > 0 ||
          (!curve.closed && (i == 0 || i == n - 1)))
        anchors.push_back(i);
    if (anchors.empty())
      anchors.push_back(0);
    const int first = anchors.front();
    int       last  = anchors.back() - n; // one turn back
    for (unsigned int k = 0, i = 0; i < curve.nodes.size(); ++i)
      {
        if (k < anchors.size() && anchors[k] == static_cast<int>(i))
          last = anchors[k++];
        before.push_back(last);
        after.push_back(k < anchors.size() ? anchors[k] : first + n);
      }
  }

  void
  AnchoredCurve::keep(const std::vector<double> &stations)
  {
    kept = stations;
  }

  unsigned int
  AnchoredCurve::n_anchors() const
  {
    return curve.nodes.size() - free_nodes().size();
  }

  std::vector<NodeId>
  AnchoredCurve::free_nodes() const
  {
    std::vector<NodeId> nodes;
    for (unsigned int i = 0; i < curve.nodes.size(); ++i)
      if (!is_anchor(i))
        nodes.push_back(curve.nodes[i]);
    return nodes;
  }

  std::pair<unsigned int, unsigned int>
  AnchoredCurve::anchors(const unsigned int i) const
  {
    const int n = curve.nodes.size();
    return {(before[i] + n) % n, after[i] % n};
  }

  double
  AnchoredCurve::relative(const unsigned int i) const
  {
    const double a = unrolled(kept, before[i]);
    return (kept[i] - a) / (unrolled(kept, after[i]) - a);
  }

  double
  AnchoredCurve::station(const unsigned int         i,
                         const std::vector<double> &now) const
  {
    const double a = unrolled(now, before[i]);
    return a + relative(i) * (unrolled(now, after[i]) - a);
  }

  double
  AnchoredCurve::unrolled(const std::vector<double> &stations,
                          const int                  i) const
  {
    const int n = curve.nodes.size();
    if (i < 0)
      return stations[i + n] - stations.back();
    if (i >= n)
      return stations[i - n] + stations.back();
    return stations[i];
  }
} // namespace alveolus
