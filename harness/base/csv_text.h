// One line of comma-separated cells, as texts.
#pragma once

#include <string>
#include <vector>

namespace cleave {

// A text as a cell: commas, quotes and line ends quoted as RFC 4180 has it.
std::string csv_cell(const std::string& text);

// The cells of one line without its end, unquoted.
std::vector<std::string> split_csv_line(const std::string& line);

}  // namespace cleave
