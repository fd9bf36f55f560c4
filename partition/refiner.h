// A refiner exchanges bodies between parts to lower the total cut weight (Liu & Andrews 2022, section 3.2).
//
// For body i in part A and target part B: E_i = edge weight from i into B, I_i = from i into the rest of A,
// c_ij = weight of the edge (i, j) or 0. A gain is exactly the decrease of the total cut weight.
// Ties: kl takes the lowest min(i, j), then the lowest max(i, j); fm the lowest body, then the lowest target
// part id. "none" is an ordinary refiner. To add one: a new file and a row in registry.cpp.
#pragma once

#include "partition/body_graph.h"
#include "partition/partition.h"

namespace cleave {

struct RefineOptions {
  int max_bodies = 25;      // n_max of the growing stage, >= 1
  double max_growth = 0.2;  // g: fm lets a part grow to floor((1 + g) max_bodies + 1e-9), g >= 0
  EdgeWeight edge_weight = EdgeWeight::rows;
  bool as_printed = false;  // the paper to the letter: pairs as edge weight, no bound on a part
};

struct RefineSummary {
  int exchanges = 0;    // swaps (kl) or moves (fm) made
  long cut_before = 0;  // total cut in the weight that was used
  long cut_after = 0;   // cut_before minus the gains; asserted equal to the cut counted from scratch
};

class Refiner {
 public:
  virtual ~Refiner() = default;

  // Throws std::invalid_argument when an option is out of range, or when the partition has not one id in
  // [0, part_count) per body or an empty part. Runs on the partition in place; asserts that no part became
  // empty and that cut_after is true.
  RefineSummary run(const BodyGraph& graph, const RefineOptions& options, Partition& partition) const;

 private:
  virtual RefineSummary do_run(const BodyGraph& graph, const RefineOptions& options,
                               Partition& partition) const = 0;
};

}  // namespace cleave
