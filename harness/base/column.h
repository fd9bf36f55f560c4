// What a manifest says about a column of steps.csv.
#pragma once

#include <string>

#include "harness/base/about.h"

namespace cleave {

struct Column {
  std::string name, help;
  bool machine = false;  // may differ between two runs of the same experiment
  About about = About::measured;
  const char* type = "text";  // integer, number or text
};

}  // namespace cleave
