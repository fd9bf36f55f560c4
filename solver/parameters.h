// Parameters that several strategies, kernels or baselines share, or whose words stand for an enumeration,
// declared once. Any other parameter of one alone stands in its row of registry.cpp.
#pragma once

#include "harness/base/parameter.h"

namespace cleave::parameters {

const Parameter& max_iterations();
const Parameter& predictor_sweeps();
const Parameter& reuse_analysis();
const Parameter& sweeps();
const Parameter& until();
const Parameter& order();  // OrderKind

}  // namespace cleave::parameters
