// cleave verify: checks what is stored from the files alone; with --rerun some of the runs are repeated too.
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <stdexcept>

#include "harness/base/names.h"
#include "harness/base/numbers.h"
#include "harness/commands/check_list.h"
#include "harness/commands/collected_tables.h"
#include "harness/commands/command.h"
#include "harness/commands/measured_cells.h"
#include "harness/commands/repeated_run.h"
#include "harness/commands/verify_directory.h"
#include "harness/commands/verify_problem_file.h"
#include "harness/files/checksums.h"
#include "harness/files/manifest.h"
#include "partition/calibration.h"

namespace cleave {
namespace {

namespace fs = std::filesystem;

// Nothing vouches for it but the other files of its directory. A collected table may have the name, but no
// manifest beside it.
bool is_file_of_run(const fs::path& path) {
  std::error_code none;
  const fs::path name = path.filename();
  return (name == kStepsFile || name == kManifestFile || name == kChecksumsFile) &&
         fs::exists(fs::absolute(path).parent_path() / kManifestFile, none);
}

void verify_file(const fs::path& path, CheckList& list) {
  std::error_code none;
  if (path.extension() == ".csv" || fs::exists(CollectedTables(path).checksums, none))
    return check_collected_tables(path, list);
  check_problem_file(path, read_problem_file_aloud(path), list);
}

struct VerifyOptions {
  std::vector<std::string> paths;
  std::string rerun;        // as given; empty: none
  std::string calibration;  // the same
};

// The calibration that is named; empty: none.
struct Calibrated {
  std::string file, fingerprint;
};

struct CompleteRun {
  fs::path directory;
  int other_threads;                         // than it had
  std::map<std::string, std::string> files;  // RepeatedRun::files
};

// Complete runs below a directory, at most so many, evenly spread over their names: in a campaign these are
// fingerprints of options, so that which are taken is as good as chance and always the same.
std::vector<CompleteRun> sample_of_runs(const std::string& path, int most, const Calibrated& by) {
  std::vector<CompleteRun> runs;
  visit_cells(find_measured_cells(std::span(&path, 1)),
              [&](const MeasuredCell& cell, const StoredManifest& manifest) {
                if (manifest.command != "run" || manifest.state != "complete") return;
                runs.push_back({cell.directory, manifest.option("threads") == "1" ? 2 : 1, {}});
                if (!by.file.empty() && manifest.option("calibration") == by.fingerprint)
                  runs.back().files.emplace("calibration", by.file);
              });
  if (runs.empty())
    throw std::invalid_argument("--rerun: " + path + " holds no run of cleave run that came to its end");
  const std::size_t count = std::min(runs.size(), static_cast<std::size_t>(most));
  std::vector<CompleteRun> sample;
  for (std::size_t k = 0; k < count; ++k) sample.push_back(runs[k * runs.size() / count]);
  return sample;
}

// With the threads it had, and with another number of them. False where it was interrupted.
bool rerun_sample(const std::string& program, const std::vector<CompleteRun>& sample, CheckList& list) {
  for (const CompleteRun& run : sample) {
    RepeatedRun again{program, run.directory, {}, {}, false, run.files};
    if (const std::vector<std::string> missing = missing_files(again); !missing.empty()) {
      CheckList::note(run.directory.string(),
                      "is not repeated, as it read files that are not named here; 'cleave rerun " +
                          run.directory.string() + " --" + joined(missing, " TEXT --") + " TEXT' does");
      continue;
    }
    for (const std::optional<int> threads : {std::optional<int>{}, std::optional<int>{run.other_threads}}) {
      again.threads = threads;
      if (!check_repeated_run(again, list)) return false;
    }
  }
  return true;
}

int verify(const VerifyOptions& options, const std::string& program) {
  if (options.paths.empty())
    throw std::invalid_argument("PATHS: problem files, output directories or collected tables are required");
  const Calibrated by{options.calibration, options.calibration.empty()
                                               ? ""
                                               : read_calibration("--calibration", options.calibration)};
  std::vector<std::vector<CompleteRun>> samples;
  if (!options.rerun.empty()) {
    const int most = parse_integer("--rerun", options.rerun, {1, std::numeric_limits<int>::max()});
    for (const std::string& path : options.paths) samples.push_back(sample_of_runs(path, most, by));
  }
  CheckList list;
  for (const std::string& path : options.paths) {
    std::error_code none;  // what cannot be looked at is no directory, and reading it says why
    if (fs::is_directory(path, none)) {
      verify_directory(path, list);
    } else if (is_file_of_run(path)) {
      verify_directory(fs::absolute(path).parent_path(), list);
    } else {
      verify_file(path, list);
    }
  }
  for (const std::vector<CompleteRun>& sample : samples)
    if (!rerun_sample(program, sample, list)) return kExitInterrupted;
  std::fflush(stdout);
  std::fprintf(stderr, "%d checks, %d failed\n", list.checks(), list.failures());
  return list.failures() == 0 ? kExitOk : kExitVerifyFailed;
}

}  // namespace

std::function<int()> declare_verify(CLI::App& app, const std::vector<std::string>& argv) {
  const auto options = std::make_shared<VerifyOptions>();
  app.add_option(
         "paths", options->paths,
         "problem files, output directories or directories of problem files, or tables of cleave collect")
      ->type_name("PATHS");
  app.add_option("--rerun", options->rerun,
                 "runs of each directory to repeat, with their own number of threads and with another")
      ->type_name("N");
  app.add_option("--calibration", options->calibration,
                 "calibration by which parts were chosen, where it is not the shipped one")
      ->type_name("FILE");
  return [options, argv] { return verify(*options, argv.front()); };
}

}  // namespace cleave
