// A refiner exchanges bodies between parts to lower the total cut weight (Liu & Andrews 2022, section 3.2).
//
// E_i(B), I_i and w_ij are those of gains.h; a gain is exactly the decrease of the total cut weight.
// Ties: kl takes the lowest min(i, j), then the lowest max(i, j); fm the lowest body, then the lowest target
// part id. "none" is an ordinary refiner. To add one: a new file, its make_...() and a row in registry.cpp.
#pragma once

#include "harness/base/parameter.h"
#include "partition/body_graph.h"
#include "partition/partition.h"

namespace cleave {

struct RefineSummary {
  int exchanges = 0;    // swaps (kl) or moves (fm) made
  long cut_before = 0;  // total cut in the weight that was used
  long cut_after = 0;   // cut_before minus the gains; asserted equal to the cut counted from scratch
};

class Refiner {
 public:
  virtual ~Refiner() = default;

  // max_bodies: n_max of the growing stage, >= 1. Throws std::invalid_argument when it is not, or when the
  // partition has not one id in [0, part_count) per body or an empty part. Runs on the partition in place;
  // asserts that no part became empty and that cut_after is true.
  RefineSummary run(const BodyGraph& graph, int max_bodies, Partition& partition) const;

 protected:
  // unit: the weight in which cuts and gains are counted.
  explicit Refiner(EdgeWeight unit) : unit_(unit) {}
  EdgeWeight unit() const { return unit_; }

 private:
  // Counts its exchanges and what they take off the cut in a summary of none.
  virtual void do_run(const BodyGraph& graph, int max_bodies, Partition& partition,
                      RefineSummary& summary) const = 0;

  EdgeWeight unit_;
};

// edge-weight, or pairs with as-printed: the paper's refiners to the letter.
EdgeWeight refining_unit(const Settings& settings);

}  // namespace cleave
