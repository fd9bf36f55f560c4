#include "harness/commands/manifested_work.h"

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

int exit_code(const RunSummary& summary) {
  if (summary.interrupted) return kExitInterrupted;
  return summary.all_ok() ? kExitOk : kExitCellsFailed;
}

}  // namespace

int do_manifested_work(const RunOptions& options, const WorkDescription& description,
                       const std::function<RunSummary()>& work) {
  const std::filesystem::path directory = create_output_directory(options.out);
  const DirectoryLock lock(directory, "cleave " + description.command);
  // Someone else may have finished there between the check and the lock.
  check_files_absent(options.out, options.force, description.files);
  if (options.force) remove_earlier_work(directory);
  for (const std::string& line : options.notes) say(line);  // a refusal is one line alone
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

}  // namespace cleave
