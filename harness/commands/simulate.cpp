#include "harness/commands/simulate.h"

#include <cstdio>
#include <filesystem>
#include <optional>
#include <utility>

#include "harness/base/printable_text.h"
#include "harness/base/progress.h"
#include "harness/base/stop_signals.h"
#include "harness/commands/check_arguments.h"
#include "harness/commands/manifested_work.h"
#include "harness/commands/motion_recorder.h"
#include "harness/experiment/model_watch.h"
#include "harness/experiment/option_values.h"
#include "harness/files/csv_recorder.h"
#include "harness/files/manifest.h"
#include "harness/files/whole_file.h"

namespace cleave {
namespace {

void tell_findings(const std::filesystem::path& out, const std::vector<ModelFinding>& findings) {
  write_whole_file(out / kFindingsFile, findings_csv(findings));
  std::fputs(findings_text(findings).c_str(), stderr);
}

}  // namespace

int simulate(const std::string& command, const std::vector<std::string>& argv, const RunOptions& options,
             const std::vector<std::string>& files, Simulation::Observer observe) {
  check_run_directory(options.out, options.force, files);
  std::optional<MotionRecorder> motion;
  if (options.record_motion) motion.emplace(std::filesystem::path(options.out) / kMotionFile, options);
  std::optional<ModelWatch> watch;
  if (options.explain_model) watch.emplace(options);
  if (motion || watch)
    observe = [&](const ObservedStep& step) {
      if (motion) motion->record(step);
      if (watch) watch->watch(step);
    };
  Simulation simulation(options, stop_requested(), std::move(observe));
  const WorkDescription work = describe_work(command, argv, options, option_values(options), files);
  return do_manifested_work(options, work, [&] {
    CsvRecorder recorder(std::filesystem::path(options.out) / kStepsFile, csv_header());
    const auto write = [&recorder](std::span<const StepRecord> rows) { recorder.append(csv_lines(rows)); };
    ProgressLine line(options.scene.text);
    RunSummary summary =
        simulation.run(write, [&line](long long done, long long total) { line.update(done, total); });
    if (motion) motion->finish();
    if (watch && summary.interrupted) {
      say("--explain-model: interrupted, so that nothing is explained and " + std::string(kFindingsFile) +
          " is not written");
    } else if (watch) {
      tell_findings(options.out, watch->findings());
    }
    return summary;
  });
}

}  // namespace cleave
