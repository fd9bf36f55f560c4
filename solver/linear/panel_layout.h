// Shape of the row panels of dense algebra (dense_panel.h).
#pragma once

namespace cleave {

inline constexpr int kPanelRows = 24;
inline constexpr int kPanelColumns = 8;  // rows of a group that is a right operand

}  // namespace cleave
