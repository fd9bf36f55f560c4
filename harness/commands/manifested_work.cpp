#include "harness/commands/manifested_work.h"

#include <signal.h>

#include <cstdio>

#include "harness/base/printable_text.h"
#include "harness/base/stop_signals.h"
#include "harness/commands/command.h"
#include "harness/experiment/option_values.h"
#include "harness/experiment/step_record.h"
#include "harness/files/checksums.h"
#include "harness/files/directory_lock.h"
#include "harness/files/output_directory.h"
#include "harness/world/ode_library.h"

namespace cleave {
namespace {

std::atomic<bool> stop{false};
static_assert(std::atomic<bool>::is_always_lock_free);

// The next one ends the program as if nothing had been set, unless it is a hang-up: a terminal that is closed may send two.
void take_stop(int) {
  stop = true;
  for (const int signal : kStopSignals) ::signal(signal, signal == SIGHUP ? SIG_IGN : SIG_DFL);
}

void stop_on_signals() {
  struct sigaction action {};
  action.sa_handler = take_stop;
  action.sa_flags = SA_RESTART;
  for (const int signal : kStopSignals) ::sigaddset(&action.sa_mask, signal);  // one handler after the other
  for (const int signal : kStopSignals)
    if (is_listened_to(signal)) ::sigaction(signal, &action, nullptr);
}

int exit_code(const RunSummary& summary) {
  if (summary.interrupted) return kExitInterrupted;
  return summary.all_ok() ? kExitOk : kExitCellsFailed;
}

}  // namespace

const std::atomic<bool>& stop_requested() { return stop; }

int do_manifested_work(const RunOptions& options, const WorkDescription& description,
                       const std::function<RunSummary()>& work) {
  const std::filesystem::path directory = create_output_directory(options.out);
  const DirectoryLock lock(directory, "cleave " + description.command);
  // Someone else may have finished there between the check and the lock.
  check_files_absent(options.out, options.force, description.files);
  if (options.force) remove_earlier_work(directory);
  stop_on_signals();
  RunSummary summary;
  Manifest manifest(directory / kManifestFile, description);
  manifest.around([&] {
    summary = work();
    return WorkResult{summary.interrupted, summary.counts()};
  });
  std::vector<std::string> files = description.files;
  files.push_back(kManifestFile);
  write_checksums(directory, files);
  std::fprintf(stderr, "%s%s", summary.text().c_str(), summary.interrupted ? "interrupted\n" : "");
  return exit_code(summary);
}

WorkDescription describe_work(const std::string& command, const std::vector<std::string>& argv,
                              const RunOptions& options, const std::vector<OptionValue>& values,
                              const std::vector<std::string>& files) {
  return {.command = command,
          .argv = argv,
          .run_id = run_id(values),
          .options = values,
          .algorithms = named_algorithms(options),
          .steps_schema = kStepsSchema,
          .columns = columns(),
          .files = files,
          .libraries = {{"ode", ode_version()}},
          .memory_limit_gb = 1e-9 * static_cast<double>(options.memory_limit_bytes)};
}

void print_left_out(const RunOptions& options) {
  for (const std::string& line : options.left_out) say(line);
}

}  // namespace cleave
