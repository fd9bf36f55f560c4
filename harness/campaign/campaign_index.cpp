#include "harness/campaign/campaign_index.h"

#include <algorithm>
#include <fstream>
#include <limits>
#include <stdexcept>

#include "harness/base/csv_text.h"
#include "harness/base/numbers.h"
#include "harness/files/checksums.h"
#include "harness/files/whole_file.h"

namespace cleave {
namespace {

namespace fs = std::filesystem;

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
  return read_whole(text, value);
}

std::string header() {
  std::string line;
  visit_index(IndexRow(),
              [&](const char* name, const auto&) { line += (line.empty() ? "" : ",") + std::string(name); });
  return line;
}

bool take_row(const std::string& line, IndexRow& row) {
  const std::vector<std::string> cells = split_csv_line(line);
  std::size_t k = 0;
  bool good = true;
  visit_index(row, [&](const char*, auto& member) {
    good = k < cells.size() && take(cells[k], member) && good;
    ++k;
  });
  return good && k == cells.size();
}

}  // namespace

std::string index_text(const std::vector<IndexRow>& rows) {
  std::string text = header() + "\n";
  for (const IndexRow& row : rows) {
    bool first = true;
    visit_index(row, [&](const char*, const auto& member) {
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
  std::vector<IndexRow> rows;
  while (std::getline(file, line)) {
    if (!take_row(line, rows.emplace_back()) || file.eof())
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
  const std::string index = index_text(rows);
  const std::string sums = checksum_line(sha256_of(share / kSpecFile), kSpecFile) +
                           checksum_line(sha256_of_bytes(index), kIndexFile);
  write_whole_files(std::vector<NamedBytes>{{share / kIndexFile, index}, {share / kChecksumsFile, sums}});
}

}  // namespace cleave
