// Whole numbers divided and rounded up.
#pragma once

namespace cleave {

// ceil(value / by) of value >= 0 and by > 0, without overflow.
template <class Integer>
constexpr Integer ceil_div(Integer value, Integer by) {
  return value / by + (value % by > 0 ? 1 : 0);
}

}  // namespace cleave
