// What a spec calls its cells: label = "rocks_{bodies}/pgs_{sweeps}", where {key} stands for the value that
// the cell has of that key.
#pragma once

#include <map>
#include <string>

#include "scenarios/file_table.h"

namespace cleave {

inline constexpr const char* kLabelKey = "label";

class CellLabel {
 public:
  // The label of a table; where it has none, that of `outer`, which may be nullptr. Throws
  // std::invalid_argument "FILE:LINE: label: text" for what is no printable text.
  CellLabel(const toml::table& table, const std::string& file, const CellLabel* outer = nullptr);

  // Empty where the spec has none. Throws the same for a { without } and for a key that the cell has not.
  std::string of(const std::map<std::string, std::string>& values) const;

  [[noreturn]] void reject(const std::string& text) const;

 private:
  std::string file_, text_;
  toml::source_region source_;
};

}  // namespace cleave
