// Parameters that several partitioners and refiners share, or whose words stand for an enumeration, declared
// once, and what they mean, with the thresholds of the paper. Any other parameter of one algorithm alone
// stands in its registry row.
#pragma once

#include "harness/base/parameter.h"
#include "partition/body_graph.h"

namespace cleave {

// What a body's degree counts (degree): distinct adjacent bodies, or joints + contact points.
enum class DegreeUnit { bodies, constraints };
// Where it is counted (degree-scope): in the whole graph, or among the bodies that are not yet in a part (the
// part being grown is one).
enum class DegreeScope { whole, left };

namespace parameters {

inline constexpr const char* kAnyKernel = "any";  // word of cost-kernel: whichever is cheapest

const Parameter& max_bodies();    // n_max: most bodies of a part while growing
const Parameter& degree();        // DegreeUnit
const Parameter& degree_scope();  // DegreeScope
const Parameter& edge_weight();   // EdgeWeight
const Parameter& as_printed();    // the paper to the letter
const Parameter& tau_mr();
const Parameter& tau_mix();
const Parameter& max_growth();
const Parameter& merge_small();
const Parameter& partition_seed();  // of the dice, for partitioners that draw
const Parameter& trials();          // of which the best counts
const Parameter& karger_method();
const Parameter& effort();  // of multilevel
const Parameter& ufactor();
const Parameter& scotch_strategy();
const Parameter& calibration();   // of the cost model: a fingerprint (calibration.h)
const Parameter& cost_kernel();   // a CostKernel that works on parts, or kAnyKernel
const Parameter& cost_threads();  // that the cost model counts on

}  // namespace parameters
}  // namespace cleave
