#include "harness/campaign/sweep.h"

#include <sched.h>
#include <signal.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <list>
#include <stdexcept>

#include "harness/base/numbers.h"
#include "harness/base/printable_text.h"
#include "harness/base/progress.h"
#include "harness/campaign/cell_process.h"
#include "harness/campaign/cell_result.h"
#include "harness/files/checksums.h"
#include "harness/files/directory_lock.h"
#include "harness/files/manifest.h"
#include "harness/files/whole_file.h"
#include "solver/step_solver.h"

namespace cleave {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

constexpr double kGrace_s = 10;       // from being asked to end to being ended
constexpr double kLookEvery_s = 1;    // at limits and progress; the end of a cell wakes us by itself
constexpr double kIndexEvery_s = 2;   // at most
constexpr double kIndexShare = 0.01;  // of the time, at most, goes into writing the index

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

struct RunningCell {
  RunningCell(std::size_t place_, int slot_, const CellCommand& command)
      : place(place_), slot(slot_), process(command) {}
  std::size_t place;
  int slot;  // which of --jobs
  CellProcess process;
  bool timed_out = false;
  double asked_at_s = std::numeric_limits<double>::infinity();  // when it was asked to end
};

class Sweep {
 public:
  Sweep(const SweepOptions& options, Campaign& campaign)
      : options_(options),
        campaign_(campaign),
        share_(share_directory(options.out, options.shard, options.shards)),
        times_(campaign.times()),
        progress_("campaign") {
    for (const IndexRow& row : campaign.rows()) summary_.kept += !row.is_pending();
    done_ = summary_.kept;
    if (options.merge) next_ = campaign.cells().size();
    for (int slot = options.jobs - 1; slot >= 0; --slot) free_slots_.push_back(slot);
  }

  SweepSummary run(const std::string& spec_text) {
    const SignalsWaitedFor signals;
    fs::create_directories(fs::path(options_.out) / kCellsFolder);
    write_whole_file(share_ / kSpecFile, spec_text);
    for (const IndexRow& row : campaign_.all_rows())
      if (!row.is_pending()) unlock(cell_directory(row));
    save_index();
    while (start_cells(), !running_.empty()) {
      const int signal = signals.wait(kLookEvery_s);
      if (signal != 0 && signal != SIGCHLD) stop(signal);
      look_at_cells();
      if (seconds_since(saved_at_) > std::max(kIndexEvery_s, save_s_ / kIndexShare)) save_index();
      show_progress();
    }
    save_index();
    return summary_;
  }

 private:
  void start_cells() {
    while (!summary_.interrupted && next_ < campaign_.cells().size() && !free_slots_.empty()) {
      if (campaign_.rows()[next_].is_pending()) start_cell(next_);
      ++next_;
    }
  }

  void start_cell(std::size_t place) {
    const IndexRow& row = campaign_.rows()[place];
    const fs::path directory = cell_directory(row);
    if (is_run_elsewhere(directory)) {
      ++summary_.elsewhere;
      return;
    }
    // Another share may have come to it since this one began.
    if (const auto done = options_.force ? std::nullopt
                                         : complete_row(options_.out, campaign_.cells()[place], row.number,
                                                        campaign_.build())) {
      take(place, *done);
      return;
    }
    if (options_.take_over) unlock(directory);
    CellCommand command{{options_.program, "run"}, options_.cell_memory_gb, cores_of(free_slots_.back())};
    for (const std::string& word : campaign_.cells()[place].arguments()) command.words.push_back(word);
    command.words.push_back("--out=" + directory.string());
    command.words.push_back("--force");
    running_.emplace_back(place, free_slots_.back(), command);
    free_slots_.pop_back();
  }

  fs::path cell_directory(const IndexRow& row) const {
    return fs::path(options_.out) / kCellsFolder / row.cell;
  }

  // A run that was killed after its last file and before its lock is complete, and the file of the lock is
  // not of it.
  void unlock(const fs::path& directory) const {
    if (!fs::exists(directory / kLockFile) || is_run_elsewhere(directory)) return;
    try {
      const DirectoryLock lock(directory, "cleave sweep",
                               options_.take_over ? LeftElsewhere::take_over : LeftElsewhere::refuse);
    } catch (const std::invalid_argument& of_another_host) {
      say(of_another_host.what());
    }
  }

  static bool is_run_elsewhere(const fs::path& directory) {
    try {
      check_not_locked(directory);
      return false;
    } catch (const std::invalid_argument&) {
      return true;
    }
  }

  std::vector<int> cores_of(int slot) const {
    if (options_.pin == 0) return {};
    static const std::vector<int> usable = usable_cores();
    const auto first = usable.begin() + static_cast<std::ptrdiff_t>(slot) * options_.pin;
    return {first, first + options_.pin};
  }

  // The first one is for the cells; a second one is for us, unless it is a hang-up: a terminal that is closed
  // may send two.
  void stop(int signal) {
    if (summary_.interrupted && signal == SIGHUP) return;
    if (summary_.interrupted) {
      running_.clear();
      ::signal(signal, SIG_DFL);
      sigset_t set;
      ::sigemptyset(&set);
      ::sigaddset(&set, signal);
      ::sigprocmask(SIG_UNBLOCK, &set, nullptr);
      ::raise(signal);
    }
    summary_.interrupted = true;
    for (RunningCell& cell : running_) ask_to_end(cell);
  }

  static void ask_to_end(RunningCell& cell) {
    cell.process.send(SIGTERM);
    cell.asked_at_s = cell.process.seconds();
  }

  void look_at_cells() {
    for (auto cell = running_.begin(); cell != running_.end();) {
      if (cell->process.has_ended()) {
        finish(*cell);
        free_slots_.push_back(cell->slot);
        cell = running_.erase(cell);
        continue;
      }
      const double seconds = cell->process.seconds();
      if (seconds > options_.cell_seconds && std::isinf(cell->asked_at_s)) {
        cell->timed_out = true;
        ask_to_end(*cell);
      }
      if (seconds > cell->asked_at_s + kGrace_s) cell->process.send(SIGKILL);
      ++cell;
    }
  }

  void finish(const RunningCell& cell) {
    const IndexRow& pending = campaign_.rows()[cell.place];
    const CellEnd end = cell.process.end();
    std::optional<IndexRow> row;
    if (end.exit_code == 0 || end.exit_code == 2)
      row = complete_row(options_.out, campaign_.cells()[cell.place], pending.number, campaign_.build());
    if (!row && summary_.interrupted && !cell.timed_out) return;  // stays pending
    if (!row)
      row = failed_row(cell, end);
    else
      fs::remove(log_path(options_.out, *row));  // of an earlier attempt
    row->process_s = cell.process.seconds();
    take(cell.place, *row);
  }

  IndexRow failed_row(const RunningCell& cell, const CellEnd& end) const {
    IndexRow row = campaign_.rows()[cell.place];
    const fs::path directory = cell_directory(row);
    if (seal(directory)) row.checksums = sha256_of(directory / kChecksumsFile);
    try {
      take_result(directory, read_manifest(directory / kManifestFile), row);
    } catch (const std::exception&) {
      // It did not come to a manifest.
    }
    row.build = campaign_.build();
    take_failure(end, cell.timed_out ? std::optional(options_.cell_seconds) : std::nullopt, row);
    write_log(row, end);
    return row;
  }

  // What is left of it gets checksums, so that the index can vouch for it. Whether there is anything.
  static bool seal(const fs::path& directory) {
    if (!fs::is_directory(directory) || is_run_elsewhere(directory)) return false;
    std::vector<std::string> names;
    for (const fs::directory_entry& entry : fs::directory_iterator(directory))
      if (entry.is_regular_file()) names.push_back(entry.path().filename());
    if (names.empty()) return false;
    std::ranges::sort(names);
    write_checksums(directory, names);
    return true;
  }

  void write_log(IndexRow& row, const CellEnd& end) const {
    const fs::path path = log_path(options_.out, row);
    fs::create_directories(path.parent_path());
    write_whole_file(path, "cell: " + row.cell + "\narguments: " + row.arguments + "\nstatus: " + row.status +
                               "\nreason: " + row.reason + "\nend: " + end.text() + "\nprinted:\n" +
                               end.printed);
    row.log = sha256_of(path);
  }

  void take(std::size_t place, const IndexRow& row) {
    campaign_.rows()[place] = row;
    times_.add(campaign_.cells()[place], seconds_of(row));
    ++done_;
    failed_ += row.status != to_string(SolveStatus::ok);
  }

  void save_index() {
    const Clock::time_point start = Clock::now();
    write_index(share_, campaign_.all_rows());
    save_s_ = seconds_since(start);
    saved_at_ = Clock::now();
  }

  std::optional<double> seconds_left() const {
    CellTimes times = times_;
    double spent_s = 0;
    for (const RunningCell& cell : running_) {
      times.add_running(campaign_.cells()[cell.place], cell.process.seconds(),
                        expected_seconds(cell.process.printed()));
      spent_s += cell.process.seconds();
    }
    const std::optional<double> all_s = campaign_.seconds_left(times, options_.jobs);
    return all_s ? std::optional(std::max(0.0, *all_s - spent_s / options_.jobs)) : std::nullopt;
  }

  void show_progress() {
    if (options_.quiet || !progress_.is_due()) return;
    const std::vector<CampaignCell>& cells = campaign_.cells();
    std::string text = std::to_string(done_) + " of " + std::to_string(cells.size()) + " cells, " +
                       std::to_string(failed_) + " failed";
    if (const auto left_s = seconds_left())
      text +=
          *left_s > 0 ? ", about " + seconds_text(*left_s) + " to go" : ", longer than cells like these took";
    for (const RunningCell& cell : running_)
      text += "; " + campaign_.rows()[cell.place].title() + " for " + seconds_text(cell.process.seconds());
    progress_.show(text);
  }

  const SweepOptions& options_;
  Campaign& campaign_;
  fs::path share_;
  CellTimes times_;
  ProgressLine progress_;
  SweepSummary summary_;
  std::list<RunningCell> running_;
  std::vector<int> free_slots_;
  std::size_t next_ = 0;
  int done_ = 0, failed_ = 0;
  Clock::time_point saved_at_ = Clock::now();
  double save_s_ = 0;
};

}  // namespace

std::vector<int> usable_cores() {
  cpu_set_t set;
  std::vector<int> cores;
  if (::sched_getaffinity(0, sizeof set, &set) == 0)
    for (int core = 0; core < CPU_SETSIZE; ++core)
      if (CPU_ISSET(static_cast<unsigned>(core), &set)) cores.push_back(core);
  return cores;
}

SweepSummary run_campaign(const SweepOptions& options, const std::string& spec_text, Campaign& campaign) {
  return Sweep(options, campaign).run(spec_text);
}

}  // namespace cleave
