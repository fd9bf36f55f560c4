#include "harness/campaign/campaign_index.h"

#include <algorithm>
#include <charconv>
#include <fstream>
#include <limits>
#include <sstream>
#include <stdexcept>

#include "harness/base/csv_text.h"
#include "harness/base/numbers.h"
#include "harness/files/checksums.h"
#include "harness/files/whole_file.h"

namespace cleave {
namespace {

namespace fs = std::filesystem;

const char* type_of(const std::string&) { return "text"; }
const char* type_of(int) { return "integer"; }
const char* type_of(double) { return "number"; }

std::string cell_text(const std::string& value) { return csv_cell(value); }
std::string cell_text(int value) { return std::to_string(value); }
std::string cell_text(double value) { return number_text(value); }

// Whether the text is a value of its kind.
bool take(const std::string& text, std::string& value) {
  value = text;
  return true;
}
template <class Number>
bool take(const std::string& text, Number& value) {
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc{} && end == text.data() + text.size();
}

std::string header() {
  std::string line;
  for (const Column& column : index_columns()) line += (line.empty() ? "" : ",") + column.name;
  return line;
}

bool take_row(const std::string& line, std::size_t columns, IndexRow& row) {
  const std::vector<std::string> cells = split_csv_line(line);
  if (cells.size() != columns) return false;
  std::size_t k = 0;
  bool good = true;
  visit_index(row, [&](const char*, auto& member, const char*) { good = take(cells[k++], member) && good; });
  return good;
}

}  // namespace

std::vector<Column> index_columns() {
  std::vector<Column> columns;
  const IndexRow row;
  visit_index(row, [&](const char* name, const auto& member, const char* help) {
    columns.push_back({name, help, false, About::bookkeeping, type_of(member)});
  });
  return columns;
}

std::string index_text(const std::vector<IndexRow>& rows) {
  std::string text = header() + "\n";
  for (const IndexRow& row : rows) {
    bool first = true;
    visit_index(row, [&](const char*, const auto& member, const char*) {
      text += (first ? "" : ",") + cell_text(member);
      first = false;
    });
    text += "\n";
  }
  return text;
}

void check_index_columns(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::string line;
  if (!std::getline(file, line)) throw std::invalid_argument(path.string() + ": cannot be read or is empty");
  if (line != header())
    throw std::invalid_argument(path.string() + ": its columns are not those of a campaign of this version");
}

std::vector<IndexRow> read_index(const fs::path& path) {
  check_index_columns(path);
  std::ifstream file(path, std::ios::binary);
  std::string line;
  std::getline(file, line);
  const std::size_t columns = index_columns().size();
  std::vector<IndexRow> rows;
  while (std::getline(file, line)) {
    if (!take_row(line, columns, rows.emplace_back()) || file.eof())
      throw std::invalid_argument(path.string() + ": line " + std::to_string(rows.size() + 1) +
                                  " is no row of an index; is it damaged?");
  }
  return rows;
}

fs::path share_directory(const fs::path& out, int shard, int shards) {
  return shards == 1 ? out : out / kShardsFolder / (std::to_string(shard) + "of" + std::to_string(shards));
}

std::vector<fs::path> share_directories(const fs::path& out) {
  std::vector<fs::path> found;
  std::error_code none;
  if (fs::exists(out / kShardsFolder, none))
    for (const fs::directory_entry& entry : fs::directory_iterator(out / kShardsFolder))
      if (fs::exists(entry.path() / kIndexFile, none)) found.push_back(entry.path());
  std::ranges::sort(found);
  if (fs::exists(out / kIndexFile, none)) found.insert(found.begin(), out);
  return found;
}

void write_index(const fs::path& share, const std::vector<IndexRow>& rows) {
  write_whole_file(share / kIndexFile, index_text(rows));
  write_checksums(share, {kSpecFile, kIndexFile});
}

}  // namespace cleave
