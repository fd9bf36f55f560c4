#include "harness/campaign/campaign.h"

#include <filesystem>
#include <set>
#include <stdexcept>

#include "harness/campaign/cell_result.h"
#include "harness/files/build_info.h"
#include "harness/files/checksums.h"
#include "harness/files/manifest.h"

namespace cleave {
namespace {

namespace fs = std::filesystem;

// Whether it is as it was written; a campaign that was killed between two files leaves it otherwise.
bool is_whole(const fs::path& share) {
  try {
    return is_as_listed(share, read_checksums(share), kIndexFile);
  } catch (const std::exception&) {
    return false;
  }
}

// What remains of a row of an index that is not whole where no log vouches for it: its directory has to say
// the rest.
IndexRow unsure(const IndexRow& row) {
  IndexRow pending;
  pending.cell = row.cell;
  pending.run_id = row.run_id;
  pending.round = row.round;
  pending.arguments = row.arguments;
  pending.label = row.label;
  pending.run_s = pending.process_s = std::numeric_limits<double>::quiet_NaN();
  return pending;
}

}  // namespace

void check_campaign_directory(const std::string& out) {
  std::error_code none;
  for (const char* file : {kManifestFile, kStepsFile})
    if (fs::exists(fs::path(out) / file, none))
      throw std::invalid_argument(
          "--out: '" + out + "' holds " + file +
          ": it is the output directory of a run and no campaign; name another directory");
  for (const fs::path& share : share_directories(out)) check_index_columns(share / kIndexFile);
}

Campaign::Campaign(const SweepOptions& options, const Spec& spec)
    : options_(options), build_(build_key(build_info())) {
  const std::vector<CampaignCell>& all = spec.cells;
  const RowsByName known = read_indexes();
  for (int k = options.shard - 1; k < static_cast<int>(all.size()); k += options.shards) {
    cells_.push_back(all[static_cast<std::size_t>(k)]);
    rows_.push_back(row_of(cells_.back(), k + 1, known));
  }
  keep_earlier(all);
}

// Of several rows of a cell, one that has ended goes before one that is pending.
Campaign::RowsByName Campaign::read_indexes() const {
  RowsByName known;
  for (const fs::path& share : share_directories(options_.out)) {
    if (!is_whole(share)) continue;
    for (IndexRow& row : read_index(share / kIndexFile)) {
      IndexRow& place = known[row.cell];
      if (place.cell.empty() || place.is_pending()) place = std::move(row);
    }
  }
  return known;
}

IndexRow Campaign::row_of(const CampaignCell& cell, int number, const RowsByName& known) {
  IndexRow pending = pending_row(cell, number);
  if (options_.force) return pending;
  if (const auto found = known.find(pending.cell); found != known.end()) {
    IndexRow row = found->second;
    const bool is_wanted = row.log == "-" || options_.keep_failed;
    if (is_wanted && row.build == build_ && row.arguments == pending.arguments &&
        still_stands(options_.out, row)) {
      row.number = number;
      row.label = pending.label;
      return row;
    }
  }
  if (const auto complete = complete_row(options_.out, cell, number, build_)) return *complete;
  if (const auto found = known.find(pending.cell); found != known.end())
    of_other_build_ += !found->second.is_pending() && found->second.build != build_;
  return pending;
}

// Cells that ran for a spec that had others.
void Campaign::keep_earlier(const std::vector<CampaignCell>& all) {
  const fs::path share = share_directory(options_.out, options_.shard, options_.shards);
  if (!fs::exists(share / kIndexFile)) return;
  std::set<std::string> names;
  for (const CampaignCell& cell : all) names.insert(cell.name());
  const bool whole = is_whole(share);
  for (IndexRow row : read_index(share / kIndexFile)) {
    if (names.contains(row.cell)) continue;
    if (!whole && !(row.log != "-" && still_stands(options_.out, row))) row = unsure(row);
    row.number = 0;
    if (row.is_pending()) take_if_complete(options_.out, row);
    if (still_stands(options_.out, row)) earlier_.push_back(std::move(row));
  }
}

CellTimes Campaign::times() const {
  CellTimes times;
  for (std::size_t k = 0; k < cells_.size(); ++k)
    if (!rows_[k].is_pending()) times.add(cells_[k], seconds_of(rows_[k]));
  return times;
}

std::optional<double> Campaign::seconds_left(const CellTimes& times, int jobs) const {
  double sum = 0;
  for (std::size_t k = 0; k < cells_.size(); ++k) {
    if (!rows_[k].is_pending()) continue;
    const std::optional<double> seconds = times.of(cells_[k]);
    if (!seconds) return std::nullopt;
    sum += *seconds;
  }
  return sum / jobs;
}

std::vector<IndexRow> Campaign::all_rows() const {
  std::vector<IndexRow> rows = rows_;
  rows.insert(rows.end(), earlier_.begin(), earlier_.end());
  return rows;
}

}  // namespace cleave
