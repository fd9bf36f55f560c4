// What is said of an option that a run cannot have: std::invalid_argument, "--option: text".
#pragma once

#include <map>
#include <stdexcept>
#include <string>

namespace cleave {

[[noreturn]] inline void reject(const std::string& option, const std::string& text) {
  throw std::invalid_argument("--" + option + ": " + text);
}

inline void require(const std::map<std::string, std::string>& given, const std::string& option,
                    const std::string& text) {
  if (!given.contains(option)) reject(option, text);
}

inline void exclude(const std::map<std::string, std::string>& given, const std::string& option,
                    const std::string& text) {
  if (given.contains(option)) reject(option, text);
}

}  // namespace cleave
