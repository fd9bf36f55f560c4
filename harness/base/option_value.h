// An option and its value as text, and an algorithm with all its parameters: what a run hands to whoever
// writes it down.
#pragma once

#include <map>
#include <string>

#include "harness/base/about.h"

namespace cleave {

enum class OptionKind { text, number, flag };

struct OptionValue {
  std::string name;
  OptionKind kind;
  std::string text;
  About about = About::bookkeeping;
  bool in_run_id = true;  // false: changes no row, such as --out
};

struct NamedAlgorithm {
  std::string kind;  // "partitioner"
  std::string text;  // as rows show it
  std::string name;
  std::map<std::string, std::string> parameters, defaults;
};

}  // namespace cleave
