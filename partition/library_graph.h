// What partitioners of other libraries share: the arrays in which these take a graph, and the graphs that
// they are not asked about.
#pragma once

#include <optional>
#include <vector>

#include "partition/body_graph.h"
#include "partition/partition.h"

namespace cleave {

// Compressed rows in the library's own type of index: neighbours of body i are neighbour[first[i] ..
// first[i + 1]). weight: of every half-edge, in `unit`.
template <class Index>
struct LibraryGraph {
  std::vector<Index> first{0}, neighbour, weight;

  LibraryGraph(const BodyGraph& graph, EdgeWeight unit) {
    first.reserve(graph.body_count() + 1);
    neighbour.reserve(2 * graph.edge_count());
    weight.reserve(2 * graph.edge_count());
    for (int body = 0; body < graph.body_count(); ++body) {
      for (int k = graph.first(body); k < graph.last(body); ++k) {
        neighbour.push_back(graph.neighbour(k));
        weight.push_back(graph.weight(k, unit));
      }
      first.push_back(static_cast<Index>(neighbour.size()));
    }
  }
};

// The split into `parts` parts where there is nothing to choose: into one, into one a body, and of a graph
// without edges, which goes by index into parts of equal size (or one body less). Libraries are not asked
// then: METIS is known to crash on such graphs.
inline std::optional<Partition> split_without_choice(const BodyGraph& graph, int parts) {
  const int bodies = graph.body_count();
  if (parts > 1 && parts < bodies && graph.edge_count() > 0) return std::nullopt;
  Partition partition{{}, parts};
  for (long body = 0; body < bodies; ++body)
    partition.part_of_body.push_back(static_cast<int>(body * parts / bodies));
  return partition;
}

}  // namespace cleave
