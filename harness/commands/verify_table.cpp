#include "harness/commands/verify_table.h"

#include <fstream>
#include <limits>
#include <stdexcept>

#include "harness/base/csv_text.h"
#include "harness/base/numbers.h"
#include "harness/experiment/earlier_tables.h"

namespace cleave {

void check_cell_count(const std::string& place, std::size_t cells, std::size_t columns) {
  if (cells != columns)
    throw std::invalid_argument(place + " has " + std::to_string(cells) +
                                " cells, allowed: " + std::to_string(columns));
}

double number_of_cell(const std::string& place, const std::string& column, const std::string& text) {
  double value = std::numeric_limits<double>::quiet_NaN();
  if (!read_whole(text, value))
    throw std::invalid_argument(place + ": " + column + " = '" + text + "', allowed: a number");
  return value;
}

StepsTable::StepsTable(const std::filesystem::path& path) : file_(path.string()) {
  std::ifstream file(path, std::ios::binary);
  std::string line;
  if (!std::getline(file, line)) throw std::invalid_argument(file_ + ": cannot be read or has no header");
  header_ = split_csv_line(line);
  for (const std::string& column : header_)
    if (!place_.emplace(column, place_.size()).second)
      throw std::invalid_argument(file_ + ": column " + column + " stands twice in the header");
  while (std::getline(file, line)) {
    rows_.push_back(split_csv_line(line));
    const std::string place = file_ + ": " + line_of(rows_.size() - 1);
    check_cell_count(place, rows_.back().size(), header_.size());
    if (file.eof()) throw std::invalid_argument(place + " has no end: the file is truncated");
  }
}

void StepsTable::add_later_columns() {
  const std::vector<std::string> later = cells_of_later_columns(header_.size());
  const std::vector<Column> all = columns();
  for (std::size_t k = header_.size(); k < all.size(); ++k) {
    place_.emplace(all[k].name, k);
    header_.push_back(all[k].name);
  }
  for (std::vector<std::string>& row : rows_) row.insert(row.end(), later.begin(), later.end());
}

const std::string& StepsTable::cell(std::size_t row, const std::string& column) const {
  const auto found = place_.find(column);
  if (found == place_.end()) throw std::invalid_argument(file_ + ": column " + column + " is missing");
  return rows_[row][found->second];
}

double StepsTable::number(std::size_t row, const std::string& column) const {
  return number_of_cell(file_ + ": " + line_of(row), column, cell(row, column));
}

std::map<std::string, std::string> cells_of(const StepRecord& row) {
  static const std::vector<Column> header = columns();
  std::string line = csv_line(row);
  line.pop_back();
  const std::vector<std::string> cells = split_csv_line(line);
  std::map<std::string, std::string> by_column;
  for (std::size_t i = 0; i < header.size(); ++i) by_column.emplace(header[i].name, cells[i]);
  return by_column;
}

}  // namespace cleave
