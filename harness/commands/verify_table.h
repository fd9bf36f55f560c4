// Reads steps.csv back.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "harness/experiment/step_record.h"

namespace cleave {

class StepsTable {
 public:
  // Throws std::invalid_argument naming the file, the line and what is wrong: no header, a column twice, a
  // line with another number of cells than the header, a last line without its end.
  explicit StepsTable(const std::filesystem::path& path);

  // Columns of the schema that came after the table was written are added to it, as nobody measured them.
  void add_later_columns();

  const std::vector<std::string>& header() const { return header_; }
  std::size_t row_count() const { return rows_.size(); }
  // Throw std::invalid_argument naming the file and the column when there is none of this name, or the cell
  // that is no number.
  const std::string& cell(std::size_t row, const std::string& column) const;
  double number(std::size_t row, const std::string& column) const;

  // "line 7" of the file.
  static std::string line_of(std::size_t row) { return "line " + std::to_string(row + 2); }

 private:
  std::string file_;
  std::vector<std::string> header_;
  std::map<std::string, std::size_t> place_;  // of a column
  std::vector<std::vector<std::string>> rows_;
};

// place: what an error begins with, "FILE: line 7". Throw std::invalid_argument: another number of cells than
// `columns`; a cell that is not wholly a number ("nan" is one).
void check_cell_count(const std::string& place, std::size_t cells, std::size_t columns);
double number_of_cell(const std::string& place, const std::string& column, const std::string& text);

// By column, what the program would write of a row.
std::map<std::string, std::string> cells_of(const StepRecord& row);

}  // namespace cleave
