// The one form in which this folder refuses bad input: "<what> is <value>, allowed: <range>".
#pragma once

#include <sstream>
#include <stdexcept>
#include <string>

namespace cleave {

template <class Value, class Range>
[[noreturn]] void refuse(const std::string& what, const Value& value, const Range& allowed) {
  std::ostringstream message;
  message << what << " is " << value << ", allowed: " << allowed;
  throw std::invalid_argument(message.str());
}

}  // namespace cleave
