// cleave rerun: one run again, from its manifest and the files that it read; its rows must be those that it
// left, in all but times and threads.
#include <filesystem>
#include <map>
#include <memory>
#include <stdexcept>

#include "harness/base/numbers.h"
#include "harness/commands/check_arguments.h"
#include "harness/commands/command.h"
#include "harness/commands/repeated_run.h"
#include "harness/experiment/repeated_options.h"
#include "harness/files/manifest.h"

namespace cleave {
namespace {

namespace fs = std::filesystem;

struct RerunOptions {
  std::string cell, out, threads;
  bool force = false;
  std::map<std::string, std::string> files;  // by option, as given
};

int rerun(const RerunOptions& options, const std::string& program) {
  if (options.cell.empty()) throw std::invalid_argument("CELL: the output directory of a run is required");
  if (options.force && options.out.empty())
    throw std::invalid_argument("--force: takes away what is in --out, which is not given");
  RepeatedRun run{program, options.cell, options.out, {}, options.force, {}};
  for (const auto& [name, value] : options.files)
    if (!value.empty()) run.files.emplace(name, value);
  if (!options.threads.empty()) run.threads = parse_integer("--threads", options.threads, {1, 1024});
  if (!options.out.empty()) {
    check_run_directory(options.out, options.force, {kStepsFile});
    const fs::path read[] = {fs::path(options.cell) / kStepsFile};
    check_not_read(fs::path(options.out) / kStepsFile, read);
  }
  CheckList list;
  if (!check_repeated_run(run, list)) return kExitInterrupted;
  return list.failures() == 0 ? kExitOk : kExitVerifyFailed;
}

}  // namespace

std::function<int()> declare_rerun(CLI::App& app, const std::vector<std::string>& argv) {
  const auto options = std::make_shared<RerunOptions>();
  app.add_option("cell", options->cell, "output directory of a run, such as a cell of a campaign")
      ->type_name("CELL");
  app.add_option("--out", options->out, "directory that keeps the repeated run; where not given, none does")
      ->type_name("DIR");
  app.add_option("--threads", options->threads, "threads of a solve, in place of those it had")
      ->type_name("N");
  for (const char* name : kOptionsOfFiles)
    app.add_option("--" + std::string(name), options->files[name],
                   "as the run was given it, where that names a file")
        ->type_name(name == std::string("calibration") ? "FILE" : "TEXT");
  app.add_flag("--force", options->force, "take away what an earlier command left in --out");
  return [options, argv] { return rerun(*options, argv.front()); };
}

}  // namespace cleave
