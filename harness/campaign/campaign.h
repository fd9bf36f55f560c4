// A campaign as its directory has it: the cells of the spec and what has become of each.
//
//     DIR/spec.toml index.csv checksums     the spec as it was read last, a row a cell, SHA-256 of both
//     DIR/cells/NAME                        the output directory of a cell
//     DIR/failed/NAME.log                   of a cell whose process did not come to its end: why, and what it
//                                           printed last
//     DIR/shards/2of4/                      spec.toml, index.csv and checksums of the second of four shares
//     DIR/slurm/                            job files and what they printed, of scripts/slurm/submit
//
// What is done is known by the directories of the cells alone. The index is written when the campaign begins,
// every few seconds and when it ends, and spares a resumed campaign the reading of every manifest.
#pragma once

#include <limits>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "harness/campaign/campaign_index.h"
#include "harness/campaign/cell_times.h"
#include "harness/campaign/spec.h"

namespace cleave {

struct SweepOptions {
  std::string spec, out;
  std::string program = "cleave";  // how the processes of cells are called
  int jobs = 1;                    // cells at a time
  int pin = 0;                     // cores of a cell; 0: not bound to any
  int shard = 1, shards = 1;       // cell k is of this share where (k - shard) % shards == 0
  double cell_seconds = std::numeric_limits<double>::infinity();
  double cell_memory_gb = std::numeric_limits<double>::quiet_NaN();  // NaN: no limit
  bool force = false, keep_failed = false, quiet = false;
  bool take_over = false;  // locks that another host left and nobody holds
  bool merge = false;      // run nothing: one index of what is there
};

// What a spec says, before anything is looked at in the directory.
struct Spec {
  std::string text;
  std::vector<CampaignCell> cells;
};

// Throws std::invalid_argument with one line for a directory of something else, and for an index of another
// version.
void check_campaign_directory(const std::string& out);

// The cells of one share with what is known of them. Making one changes nothing.
class Campaign {
 public:
  Campaign(const SweepOptions& options, const Spec& spec);

  const std::vector<CampaignCell>& cells() const { return cells_; }
  std::vector<IndexRow>& rows() { return rows_; }  // one a cell, in their order
  const std::vector<IndexRow>& rows() const { return rows_; }
  const std::vector<IndexRow>& earlier() const { return earlier_; }  // of earlier specs, complete
  const std::string& build() const { return build_; }
  int of_other_build() const { return of_other_build_; }  // pending cells that another build has done
  CellTimes times() const;                                // of the cells that have ended
  // For those that are pending, those that run from their beginning, so many at a time; nothing before the
  // first has ended.
  std::optional<double> seconds_left(const CellTimes& times, int jobs) const;

  std::vector<IndexRow> all_rows() const;

 private:
  using RowsByName = std::map<std::string, IndexRow>;
  RowsByName read_indexes() const;
  IndexRow row_of(const CampaignCell& cell, int number, const RowsByName& known);
  void keep_earlier(const std::vector<CampaignCell>& all);

  SweepOptions options_;
  std::string build_;
  int of_other_build_ = 0;
  std::vector<CampaignCell> cells_;
  std::vector<IndexRow> rows_, earlier_;
};

}  // namespace cleave
