// A partition of the bodies into parts (the subsystems of the parallel solver), and its metrics.
//
// Part ids are 0 .. part_count-1 in order of creation and stay so under refinement. No part is empty. Parts
// of a solver that takes an interface at every level are the leaves of a tree (nested.h).
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "partition/body_graph.h"

namespace cleave {

struct Partition {
  std::vector<int> part_of_body;  // (n)
  int part_count = 0;
  std::string choice = {};               // of a partitioner that chooses others: what made it, else empty
  std::vector<int> parent_of_part = {};  // (nodes of the tree): -1 for the root; empty: one level
};

// The kernel that a choice is for, "schur-rows" of "mix@max-bodies=50+fm/schur-rows"; empty of an empty
// choice.
std::string_view kernel_of_choice(std::string_view choice);

// Parts numbered by their lowest body. label_of_body: (n) equal within a part and nowhere else, in [0, n).
Partition numbered_by_lowest_body(std::span<const int> label_of_body);

// All numbers are computed from scratch from the graph and the part ids, never kept up to date by an
// algorithm: they are what the incremental gains of the refiners are checked against.
struct PartitionMetrics {
  int parts = 0;
  int max_part_bodies = 0;         // bodies of the largest part
  int cut_pairs = 0;               // body pairs whose ends lie in different parts
  int cut_constraints = 0;         // joints + contact points at the cut
  int interface_rows = 0;          // constraint rows at the cut: the size of the interface system
  int interface_bodies = 0;        // bodies with at least one cut edge
  int interface_cover_bodies = 0;  // bodies of a small vertex cover of the cut edges (greedy: most uncovered
                                   // cut edges first, lowest index on ties)
  bool contiguous = true;          // every part is connected inside the part
  double part_mass_ratio_max = 1;  // largest heaviest/lightest body within one part; 1 for single bodies
};

// Throws std::invalid_argument when part_of_body has not one id per body or an id lies outside [0, n). Ids
// that no body carries are not counted as parts.
PartitionMetrics measure_partition(const BodyGraph& graph, std::span<const int> part_of_body);

// Total weight of the edges whose ends lie in different parts.
long cut_weight(const BodyGraph& graph, std::span<const int> part_of_body, EdgeWeight unit);

// Most bodies of a part of max_bodies that may grow: floor((1 + max_growth) max_bodies + 1e-9).
int most_grown_bodies(int max_bodies, double max_growth);

// ceil(bodies / max_bodies): how many parts are wanted.
inline int wanted_parts(int bodies, int max_bodies) {
  return bodies / max_bodies + (bodies % max_bodies > 0);
}

// Part sizes in bodies, by part id. Every id must lie in [0, part_count).
std::vector<int> part_sizes(const Partition& partition);

}  // namespace cleave
