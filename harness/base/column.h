// What a manifest says about a column of steps.csv.
#pragma once

#include <string>

#include "harness/base/about.h"

namespace cleave {

struct Column {
  std::string name, help;
  bool machine;  // may differ between two runs of the same experiment
  About about;
  const char* type;  // integer, number or text
};

}  // namespace cleave
