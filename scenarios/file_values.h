// Numbers, vectors and names as scene files hold them.
#pragma once

#include <array>
#include <span>
#include <string>

#include "harness/base/names.h"
#include "scenarios/file_number.h"
#include "scenarios/file_table.h"

namespace cleave::scene_file {

inline const Range kAnyLength_m{-1e6, 1e6};
inline const Range kSize_m{1e-6, 1e6};

// A number, { from = A, to = B } or { one_of = [A, B, ...] }, each in the range.
Number read_number(const Value& value, const Range& range);
// Three of these.
DrawnVector read_drawn_vector(const Value& value, const Range& range);
std::array<double, 3> read_vector(const Value& value, const Range& range);
// Of any length but zero, in any unit.
std::array<double, 3> read_direction(const Value& value);

// The row of a table of kinds that the value names.
template <class Kind>
const Kind& read_kind(const Value& value, std::span<const Kind> kinds) {
  const std::vector<std::string> names = names_of(kinds);
  const std::string name = value.text("one of " + joined(names));
  for (const Kind& kind : kinds)
    if (name == kind.name) return kind;
  value.reject(unknown_name_text(name, names));
}

}  // namespace cleave::scene_file
