// Which column of steps.csv each parameter of an algorithm has, and where it stands.
//
// A column keeps its place for good: readers of older tables go by it. The parameters that have one are
// listed in parameter_columns.cpp; whatever a registry adds later comes at the end of the table by itself, in
// the order of the registries. Who then adds another column behind it lists it there first.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "harness/base/about.h"
#include "harness/experiment/algorithms.h"

namespace cleave {

struct ParameterColumn {
  // The column that it stands behind, together with others.
  enum class Place {
    after_status,
    after_contact_cap,
    after_factor_mflop_done,
    after_friction_beyond_share,
    after_body_order,
    at_end
  };

  std::string name, help;
  About about;
  Place place;
};

// Of these parameters, in the order in which they stand.
std::vector<ParameterColumn> columns_of(std::span<const CommonParameter> parameters);

// Of all parameters of this program.
std::span<const ParameterColumn> parameter_columns();

}  // namespace cleave
