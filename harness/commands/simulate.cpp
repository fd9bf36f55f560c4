#include "harness/commands/simulate.h"

#include <optional>
#include <utility>

#include "harness/commands/manifested_work.h"
#include "harness/csv_recorder.h"
#include "harness/manifest.h"
#include "harness/motion_recorder.h"
#include "harness/output_directory.h"
#include "harness/progress.h"

namespace cleave {

int simulate(const std::string& command, const std::vector<std::string>& argv, const RunOptions& options,
             Simulation::Observer observe) {
  std::optional<MotionRecorder> motion;
  if (options.record_motion) motion.emplace(std::filesystem::path(options.out) / "motion.h5", options);
  Simulation::Watcher watch;
  if (motion) watch = [&](const auto&... seen) { motion->record(seen...); };
  Simulation simulation(options, stop_requested(), std::move(observe), std::move(watch));
  const std::filesystem::path out = create_output_directory(options.out);
  if (options.force && !motion) std::filesystem::remove(out / "motion.h5");  // of the run that is overwritten
  Manifest manifest(out / "manifest.json", command, argv, option_values(options));
  return do_manifested_work(manifest, [&] {
    CsvRecorder recorder(out / "steps.csv");
    ProgressLine line(options.scene);
    RunSummary summary = simulation.run(recorder, [&line](int done, int total) { line.update(done, total); });
    if (motion) motion->finish();
    return summary;
  });
}

}  // namespace cleave
