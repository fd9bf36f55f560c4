// The columns of steps.csv that two runs of the same experiment may differ in, as visit_fields marks them.
#pragma once

#include <algorithm>
#include <string>

#include "harness/experiment/step_record.h"

namespace cleave {

inline bool is_of_the_machine(const std::string& name) {
  return std::ranges::any_of(columns(),
                             [&](const Column& column) { return column.name == name && column.machine; });
}

}  // namespace cleave
