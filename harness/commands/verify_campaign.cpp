#include "harness/commands/verify_campaign.h"

#include <algorithm>
#include <cstdio>
#include <map>
#include <stdexcept>
#include <tuple>

#include "harness/base/names.h"
#include "harness/base/numbers.h"
#include "harness/base/refusals.h"
#include "harness/campaign/cell_result.h"
#include "harness/campaign/spec.h"
#include "harness/commands/collected_tables.h"
#include "harness/commands/verify_directory.h"
#include "harness/files/checksums.h"
#include "harness/files/directory_lock.h"
#include "harness/files/manifest.h"

namespace cleave {
namespace {

namespace fs = std::filesystem;

using Rows = std::map<std::string, std::vector<IndexRow>>;  // by cell

// Which share of how many a directory holds, by its name; all of it otherwise.
std::pair<int, int> share_of(const fs::path& out, const fs::path& share) {
  if (share == out) return {1, 1};
  const std::string name = share.filename().string(), option = share.string() + ": share I of N, IofN";
  const std::size_t of = name.find("of");
  if (of == std::string::npos) throw std::invalid_argument(share.string() + " is no share, allowed: IofN");
  const int shards = parse_integer(option, name.substr(of + 2), {1, kMostCells});
  return {parse_integer(option, name.substr(0, of), {1, static_cast<double>(shards)}), shards};
}

// Pending, as the spec of a share lists them.
std::vector<IndexRow> cells_of_spec(const fs::path& out, const fs::path& share) {
  const fs::path path = share / kSpecFile;
  const std::vector<CampaignCell> cells = parse_campaign(read_spec(path.string()), path.string());
  const auto [shard, shards] = share_of(out, share);
  std::vector<IndexRow> expected;
  for (int k = shard - 1; k < static_cast<int>(cells.size()); k += shards)
    expected.push_back(pending_row(cells[static_cast<std::size_t>(k)], k + 1));
  return expected;
}

bool is_same_cell(const IndexRow& a, const IndexRow& b) {
  const auto key = [](const IndexRow& row) {
    return std::tie(row.cell, row.number, row.run_id, row.round, row.arguments, row.label);
  };
  return key(a) == key(b);
}

// In words; empty: there is none.
std::string find_other_cell(const std::vector<IndexRow>& rows, const std::vector<IndexRow>& expected) {
  const auto is_of_spec = [](const IndexRow& row) { return row.number > 0; };
  if (std::ranges::count_if(rows, is_of_spec) != std::ssize(expected))
    return "; it has another number of cells";
  for (std::size_t k = 0; k < expected.size(); ++k)
    if (!is_same_cell(rows[k], expected[k]))
      return "; line " + std::to_string(k + 2) + " is not cell " + std::to_string(expected[k].number) +
             " of it";
  return {};
}

// The index has the cells of its spec, numbered as that has them.
void check_spec(const fs::path& out, const fs::path& share, const std::vector<IndexRow>& rows,
                CheckList& list) {
  const std::string wrong = wrong_in([&] { return find_other_cell(rows, cells_of_spec(out, share)); });
  list.add(wrong.empty(), (share / kIndexFile).string(), "has the cells of spec.toml" + wrong);
}

// What may lie beside the index, besides the files that the checksums beside it name.
std::vector<std::string> others_beside_index(const fs::path& out) {
  std::vector<std::string> names = {kCellsFolder, kFailedFolder, kShardsFolder, kSlurmFolder, kLockFile};
  if (!fs::exists(out / kMergedTable)) return names;
  const CollectedTables merged(out / kMergedTable);
  for (const fs::path& table : merged.tables()) names.push_back(table.filename().string());
  names.push_back(merged.checksums.filename().string());
  return names;
}

void read_share(const fs::path& out, const fs::path& share, Rows& rows, CheckList& list) {
  // One that was killed leaves its lock, a share also where other shares have done its cells since. What is
  // to do is pending.
  const std::vector<std::string> others =
      share == out ? others_beside_index(out) : std::vector<std::string>{kLockFile};
  if (!check_files(share, {kIndexFile, kSpecFile}, others, list)) return;
  std::vector<IndexRow> found;
  const std::string error = wrong_in([&] { found = read_index(share / kIndexFile); });
  list.add(error.empty(), (share / kIndexFile).string(), "readable" + error);
  if (!error.empty()) return;
  check_spec(out, share, found, list);
  for (const IndexRow& row : found) rows[row.cell].push_back(row);
}

// What the index says is what the directory of the cell says.
void check_row(const fs::path& out, const IndexRow& row, CheckList& list) {
  const fs::path directory = out / kCellsFolder / row.cell;
  std::string wrong;
  try {
    const StoredManifest manifest = read_manifest(directory / kManifestFile);
    IndexRow found = row;
    found.run_id = manifest.run_id;
    take_result(directory, manifest, found);
    found.cell = found.run_id + "_t" + manifest.option("threads") + "_r" + std::to_string(row.round);
    const std::string stored = index_text({row}), expected = index_text({found});
    if (stored != expected) wrong = "; its directory gives " + expected.substr(expected.find('\n') + 1);
    if (wrong.ends_with("\n")) wrong.pop_back();
  } catch (const std::exception& error) {
    wrong = std::string("; ") + error.what();
  }
  list.add(wrong.empty(), directory.string(), "is as the index says" + wrong);
}

// Of the rows of a cell in several indexes, the one that its directory stands for.
void check_cell(const fs::path& out, const std::string& cell, const std::vector<IndexRow>& rows,
                CheckList& list) {
  const fs::path directory = out / kCellsFolder / cell;
  if (std::ranges::all_of(rows, &IndexRow::is_pending))
    return list.add(false, directory.string(), "pending: the campaign is incomplete");
  const auto row = std::ranges::find_if(rows, [&](const IndexRow& one) { return still_stands(out, one); });
  if (row == rows.end()) {
    const auto ended = std::ranges::find_if_not(rows, &IndexRow::is_pending);
    return list.add(false, changed_file(out, *ended)->string(), "is not that of the index");
  }
  if (row->log == "-") {
    verify_directory(directory, list);
    check_row(out, *row, list);
  } else if (row->checksums != "-") {
    check_files(directory, {}, {}, list);
  }
}

// What no index knows.
void check_no_strangers(const fs::path& folder, const std::string& ending, const Rows& rows,
                        CheckList& list) {
  std::error_code none;
  if (!fs::is_directory(folder, none)) return;
  std::string others;
  for (const std::string& name : names_in(folder)) {
    const bool ends = name.ends_with(ending);
    const auto found = rows.find(ends ? name.substr(0, name.size() - ending.size()) : "");
    const bool has_log = found != rows.end() && std::ranges::any_of(found->second, [](const IndexRow& row) {
                           return row.log != "-";
                         });
    if (found == rows.end() || (!ending.empty() && !has_log)) others += "; " + name + " is in no index";
  }
  list.add(others.empty(), folder.string(), "holds what the index names" + others);
}

void check_shares(const fs::path& out, const std::vector<fs::path>& shares, CheckList& list) {
  std::string others;
  if (fs::is_directory(out / kShardsFolder))
    for (const std::string& name : names_in(out / kShardsFolder))
      if (std::ranges::count(shares, out / kShardsFolder / name) == 0)
        others += "; " + name + " has no index";
  const std::vector<std::string> known = others_beside_index(out);
  if (!fs::exists(out / kIndexFile))
    for (const std::string& name : names_in(out))
      if (std::ranges::count(known, name) == 0) others += "; " + name + " is not of this campaign";
  list.add(others.empty(), out.string(), "holds a campaign and nothing else" + others);
}

}  // namespace

bool is_campaign(const fs::path& directory) {
  return fs::exists(directory / kIndexFile) || fs::is_directory(directory / kShardsFolder) ||
         (fs::is_directory(directory / kCellsFolder) && fs::exists(directory / kSpecFile));
}

void verify_campaign(const fs::path& directory, CheckList& list) {
  const std::vector<fs::path> shares = share_directories(directory);
  check_shares(directory, shares, list);
  if (shares.empty()) return list.add(false, (directory / kIndexFile).string(), "is missing");
  Rows rows;
  const int before = list.failures();
  for (const fs::path& share : shares) read_share(directory, share, rows, list);
  if (list.failures() > before)
    return CheckList::note(
        directory.string(),
        "its cells were not looked at, for what is wrong with its index or with what lies beside it");
  for (const auto& [cell, of_cell] : rows) check_cell(directory, cell, of_cell, list);
  check_no_strangers(directory / kCellsFolder, "", rows, list);
  check_no_strangers(directory / kFailedFolder, ".log", rows, list);
  for (const fs::path& merged : {directory / kMergedTable, directory / kSlurmFolder / kMergedTable})
    if (fs::exists(merged)) check_collected_tables(merged, list);
}

}  // namespace cleave
