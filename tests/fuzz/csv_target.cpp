// steps.csv as `cleave verify` reads it.
#include <algorithm>
#include <optional>

#include "harness/base/csv_text.h"
#include "harness/base/numbers.h"
#include "harness/commands/verify_table.h"
#include "tests/fuzz/scratch_file.h"
#include "tests/fuzz/target.h"

namespace cleave::fuzz {
namespace {

using Cells = std::vector<std::string>;

std::vector<std::string> lines_of(std::string_view bytes) {
  std::vector<std::string> lines;
  while (!bytes.empty()) {
    const std::size_t end = bytes.find('\n');
    lines.emplace_back(bytes.substr(0, end));
    bytes.remove_prefix(std::min(bytes.size(), lines.back().size() + 1));
  }
  return lines;
}

std::string line_of(const Cells& cells) {
  std::string line;
  for (const std::string& cell : cells) {
    line += line.empty() ? "\"" : ",\"";
    for (const char c : cell) line += c == '"' ? "\"\"" : std::string(1, c);
    line += '"';
  }
  return line;
}

// A number that is taken is written and read as itself.
void check_number(const StepsTable& table, std::size_t row, const std::string& column) {
  double value = 0;
  if (refuses([&] { value = table.number(row, column); })) return;
  const std::string text = number_text(value);
  const double again = StepsTable(ScratchFile("x\n" + text + "\n").path()).number(0, "x");
  require(number_text(again) == text, "a number is read as another one: " + text);
}

void check_row(const StepsTable& table, std::size_t row, const Cells& header, const Cells& cells) {
  require(cells.size() == header.size(), "a row is not as wide as the header");
  require(split_csv_line(line_of(cells)) == cells, "cells are not read as they are written");
  for (const std::string& column : header) {
    const auto first = std::ranges::find(header, column) - header.begin();
    require(table.cell(row, column) == cells[first], "a cell is that of another column");
  }
  check_number(table, row, header[row % header.size()]);
}

}  // namespace

void read_csv(std::string_view bytes) {
  const ScratchFile file(bytes);
  std::optional<StepsTable> table;
  if (refuses([&] { table.emplace(file.path()); })) return;
  const std::vector<std::string> lines = lines_of(bytes);
  require(bytes.empty() || lines.size() == table->row_count() + 1, "a line is no row");
  const Cells header = split_csv_line(lines.empty() ? "" : lines.front());
  for (std::size_t row = 0; row < table->row_count(); ++row)
    check_row(*table, row, header, split_csv_line(lines[row + 1]));
  require(refuses([&] { table->cell(0, "no such column\n"); }), "a column is there that is not");
}

}  // namespace cleave::fuzz
