// What a reader refuses by std::invalid_argument, told by whoever called it.
#pragma once

#include <stdexcept>
#include <string>
#include <type_traits>

namespace cleave {

// read(), where a refusal names `context` first: the option that asked, or the file that is read.
template <class Read>
auto in_context(const std::string& context, const Read& read) {
  try {
    return read();
  } catch (const std::invalid_argument& refusal) {
    throw std::invalid_argument(context + ": " + refusal.what());
  }
}

// What is wrong, for the end of a line of a check: what look() returns, if it returns a text, or "; " and
// what it refuses; empty where nothing is.
template <class Look>
std::string wrong_in(const Look& look) {
  try {
    if constexpr (!std::is_void_v<std::invoke_result_t<Look>>) return look();
    look();
    return {};
  } catch (const std::invalid_argument& refusal) {
    return std::string("; ") + refusal.what();
  }
}

}  // namespace cleave
