#include "harness/commands/measured_cells.h"

#include <algorithm>
#include <exception>
#include <fstream>
#include <map>
#include <set>
#include <stdexcept>

#include "harness/base/csv_text.h"
#include "harness/commands/verify_table.h"
#include "harness/experiment/earlier_tables.h"
#include "harness/experiment/step_record.h"
#include "harness/files/checksums.h"
#include "harness/files/manifest.h"

namespace cleave {
namespace {

namespace fs = std::filesystem;

bool is_cell(const fs::path& directory) {
  return fs::is_regular_file(directory / kManifestFile) && fs::is_regular_file(directory / kStepsFile);
}

std::vector<fs::path> cells_below(const fs::path& root) {
  std::vector<fs::path> found;
  if (is_cell(root)) found.push_back(root);
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(root))
    if (entry.is_directory() && !entry.is_symlink() && is_cell(entry.path())) found.push_back(entry.path());
  std::ranges::sort(found);
  return found;
}

[[noreturn]] void refuse_columns(const std::string& place) {
  throw std::invalid_argument(place + ": its columns are not those of " + kStepsSchema +
                              "; was it written by another version?");
}

// Of a run that has ended and was changed since. One that goes on, or was killed, has no checksums.
void check_sum(const fs::path& directory) {
  if (!fs::exists(directory / kChecksumsFile)) return;
  const std::map<std::string, std::string> sums = read_checksums(directory);
  if (sums.contains(kStepsFile) && !is_as_listed(directory, sums, kStepsFile))
    throw std::invalid_argument((directory / kStepsFile).string() + ": is not what the run wrote, by " +
                                (directory / kChecksumsFile).string() + "; 'cleave verify " +
                                directory.string() + "' says more");
}

struct ReadManifest {
  StoredManifest manifest;
  std::exception_ptr error;
};

std::vector<ReadManifest> read_manifests(std::span<const MeasuredCell> cells) {
  std::vector<ReadManifest> read(cells.size());
#pragma omp parallel for schedule(dynamic)
  for (std::size_t k = 0; k < cells.size(); ++k) {
    try {
      read[k].manifest = read_manifest(cells[k].directory / kManifestFile);
    } catch (...) {
      read[k].error = std::current_exception();
    }
  }
  return read;
}

}  // namespace

std::vector<MeasuredCell> find_measured_cells(std::span<const std::string> directories) {
  std::vector<MeasuredCell> cells;
  std::set<fs::path> known;
  for (const std::string& text : directories) {
    if (!fs::is_directory(text)) throw std::invalid_argument(text + ": is no directory");
    const std::vector<fs::path> found = cells_below(fs::path(text).lexically_normal());
    if (found.empty())
      throw std::invalid_argument(text + ": holds no output directory (manifest.json beside steps.csv)");
    for (const fs::path& directory : found) {
      if (!known.insert(fs::canonical(directory)).second)
        throw std::invalid_argument(directory.string() + ": is asked for twice");
      cells.push_back({directory.string(), directory});
    }
  }
  return cells;
}

void visit_cells(std::span<const MeasuredCell> cells,
                 const std::function<void(const MeasuredCell& cell, const StoredManifest& manifest)>& visit) {
  constexpr std::size_t kAtATime = 256;
  for (std::size_t first = 0; first < cells.size(); first += kAtATime) {
    const std::span<const MeasuredCell> some = cells.subspan(first, std::min(kAtATime, cells.size() - first));
    const std::vector<ReadManifest> read = read_manifests(some);
    for (std::size_t k = 0; k < some.size(); ++k) {
      if (read[k].error) std::rethrow_exception(read[k].error);
      visit(some[k], read[k].manifest);
    }
  }
}

bool visit_rows(const MeasuredCell& cell, const std::function<void(const MeasuredRow& row)>& visit) {
  const fs::path path = cell.directory / kStepsFile;
  check_sum(cell.directory);
  std::ifstream file(path, std::ios::binary);
  std::string line;
  std::getline(file, line);
  const std::vector<std::string> header = split_csv_line(line);
  if (!are_columns_of_schema(header)) refuse_columns(path.string());
  const std::vector<std::string> later = cells_of_later_columns(header.size());
  const auto schema = std::ranges::find(header, "schema_version") - header.begin();
  for (std::size_t row = 0; std::getline(file, line); ++row) {
    if (file.eof()) return false;
    MeasuredRow found = {line, split_csv_line(line), path.string() + ": " + StepsTable::line_of(row)};
    check_cell_count(found.place, found.cells.size(), header.size());
    if (found.cells[schema] != kStepsSchema) refuse_columns(found.place);
    for (const std::string& text : later) {
      found.line += "," + text;
      found.cells.push_back(text);
    }
    visit(found);
  }
  return true;
}

}  // namespace cleave
