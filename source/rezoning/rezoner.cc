// SPDX-License-Identifier: LGPL-2.1-or-later
#include <alveolus/base/problems.h>
#include <alveolus/mesh/quality.h>
#include <alveolus/rezoning/rezoner.h>

#include <deal.II/base/mpi.h>

#include <algorithm>
#include <array>
#include <sstream>
#include <unordered_map>

namespace alveolus
{
  using namespace dealii;

  template <int dim>
  void
  Rezoner<dim>::add(std::unique_ptr<RezoningRule<dim>> rule,
                    const std::string                 &where)
  {
    rules.emplace_back(where, std::move(rule));
  }

  template <int dim>
  void
  Rezoner<dim>::attach(const Nodes<dim> &nodes, const NodalVector &positions)
  {
    using Stage                     = typename RezoningRule<dim>::Stage;
    const auto        &mesh         = nodes.configuration.mesh;
    const MPI_Comm     communicator = nodes.configuration.communicator();
    const unsigned int none         = rules.size();
    hanging = std::make_unique<HangingNodes<dim>>(nodes.configuration);

    const auto stage = [&](const auto &rule) {
      return rule.second->stage(mesh.names, rule.first);
    };
    // The stage of a rule depends on the names it acts on.
    Problems problems;
    for (const auto &rule : rules)
      problems.collect([&]() { stage(rule); });
    problems.throw_if_any();
    std::stable_sort(rules.begin(),
                     rules.end(),
                     [&](const auto &a, const auto &b) {
                       return stage(a) < stage(b);
                     });
    std::set<NodeId> taken;
    // The rule of this stage that sets a component of an owned node
    std::unordered_map<NodeId, std::array<unsigned int, dim>> setter;
    for (unsigned int r = 0; r < rules.size(); ++r)
      {
        RezoningRule<dim> &rule = *rules[r].second;
        const Stage        now  = stage(rules[r]);
        problems.collect(
          [&]() { rule.attach(nodes, positions, taken, rules[r].first); });
        if (!problems.none())
          continue; // to hear what the others have to say

        unsigned int        rival = none;
        NodeId              where = numbers::invalid_dof_index;
        std::vector<NodeId> mine;
        for (const NodeId node : rule.touched_nodes())
          if (nodes.is_owned(node))
            {
              std::array<unsigned int, dim> nobody;
              nobody.fill(none);
              auto &entry = setter.emplace(node, nobody).first->second;
              for (unsigned int c = 0; c < dim; ++c)
                if (rule.touched_components()[c])
                  {
                    if (entry[c] < rival)
                      {
                        rival = entry[c];
                        where = node;
                      }
                    entry[c] = r;
                  }
              mine.push_back(node);
            }
        const unsigned int first = Utilities::MPI::min(rival, communicator);
        if (first != none)
          {
            const NodeId node =
              Utilities::MPI::min(rival == first ? where
                                                 : numbers::invalid_dof_index,
                                  communicator);
            std::ostringstream found;
            found << "sets the node at ("
                  << nodes.gather(nodes.configuration.initial_positions(),
                                  {node})[0]
                  << "), which "
                  << (first == r ? "two of its own sets contain"
                                 : "'" + rules[first].first + "' sets, too");
            throw InputError(rules[r].first,
                             found.str(),
                             "let one rule of a stage set it");
          }

        // Rules of later stages leave these nodes alone.
        if (r + 1 < rules.size() && stage(rules[r + 1]) != now)
          {
            std::vector<NodeId> all;
            for (const auto &entry : setter)
              all.push_back(entry.first);
            for (const auto &part :
                 Utilities::MPI::all_gather(communicator, all))
              taken.insert(part.begin(), part.end());
            setter.clear();
          }
      }
    problems.throw_if_any();
  }

  template <int dim>
  NodalVector
  Rezoner<dim>::propose(const Nodes<dim>  &nodes,
                        const NodalVector &start,
                        const NodalVector &lagrangian,
                        RezoningReport    &report) const
  {
    constexpr unsigned int most_halvings = 8;

    report = RezoningReport();
    NodalVector proposed(lagrangian);
    proposed.update_ghost_values();
    for (const auto &rule : rules)
      {
        rule.second->apply(nodes, start, lagrangian, proposed, report);
        hanging->distribute(proposed);
      }

    NodalVector trial(proposed);
    trial.update_ghost_values();
    for (unsigned int halvings = 0;; ++halvings)
      {
        const auto quality      = mesh_quality(nodes.configuration, trial);
        report.smallest_quality = quality.smallest_scaled_jacobian;
        const bool valid        = quality.smallest_scaled_jacobian > 0. &&
                           quality.smallest_point_jacobian > 0.;
        if (valid || report.fraction == 0.)
          break;
        report.cut_back = true;
        report.fraction = halvings < most_halvings ? 0.5 * report.fraction : 0.;
        // Not a combination of vectors: 0 times an infinite proposal is none.
        for (unsigned int i = 0; i < trial.locally_owned_size(); ++i)
          {
            const double x = lagrangian.local_element(i);
            trial.local_element(i) =
              report.fraction == 0.
                ? x
                : x + report.fraction * (proposed.local_element(i) - x);
          }
        trial.update_ghost_values();
        hanging->distribute(trial);
      }

    double motion = 0.;
    for (const NodeId node : nodes.relevant())
      if (nodes.is_owned(node))
        motion = std::max(
          motion, nodes.get(trial, node).distance(nodes.get(lagrangian, node)));
    report.largest_motion =
      Utilities::MPI::max(motion, nodes.configuration.communicator());
    return trial;
  }

  template class Rezoner<2>;
  template class Rezoner<3>;
} // namespace alveolus
