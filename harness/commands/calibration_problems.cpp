#include "harness/commands/calibration_problems.h"

#include <map>

#include "harness/base/progress.h"
#include "harness/base/stop_signals.h"
#include "harness/commands/manifested_work.h"
#include "harness/experiment/simulation.h"
#include "harness/files/problem_file.h"

namespace cleave {
namespace {

using Given = std::map<std::string, std::string>;

struct Source {
  const char *scene, *size, *count, *at;
};

// Every second one is held out, so that sizes and scenes are in both halves.
constexpr Source kSources[] = {
    {"rock_pile", "bodies", "50", "60,80,100,125,150,180,215,250"},
    {"rock_pile", "bodies", "75", "60,80,100,125,150,180,215,250"},
    {"rock_pile", "bodies", "100", "60,80,100,125,150,180,215,250"},
    {"rock_pile", "bodies", "150", "60,80,100,125,150,180,215,250"},
    {"rock_pile", "bodies", "200", "70,90,110,140,170,200,240,280"},
    {"rock_pile", "bodies", "300", "70,90,110,140,170,200,240,280"},
    {"large_rock_pile", "bodies", "100", "70,90,110,140,170,200,240,280"},
    {"large_rock_pile", "bodies", "200", "70,90,110,140,170,200,240,280"},
    {"large_rock_pile", "bodies", "300", "70,90,110,140,170,200,240,280"},
    {"large_rock_pile", "bodies", "400", "70,90,110,140,170,200,240,280"},
    {"log_tower", "layers", "10", "20,50,65,75,85,100,115,130"},
    {"log_tower", "layers", "15", "20,50,65,75,85,100,115,130"},
    {"log_tower", "layers", "20", "20,50,65,75,85,100,115,130"},
    {"log_tower", "layers", "25", "20,50,65,75,85,100,115,130"},
    {"log_tower", "layers", "30", "20,50,65,75,85,100,115,130"},
    {"log_tower", "layers", "40", "20,50,65,75,85,100,115,130"},
    {"chain_drop", "links", "50", "60,80,100,125,150,180,215,250"},
    {"chain_drop", "links", "75", "60,80,100,125,150,180,215,250"},
    {"chain_drop", "links", "100", "60,80,100,125,150,180,215,250"},
    {"chain_drop", "links", "150", "60,80,100,125,150,180,215,250"},
    {"silo", "bodies", "50", "10,15,20,25,30,35,40,50"},
    {"silo", "bodies", "80", "10,15,20,25,30,35,40,50"},
    {"silo", "bodies", "100", "10,15,20,25,30,35,40,50"},
    {"silo", "bodies", "120", "10,15,20,25,30,35,40,50"},
    {"silo", "bodies", "150", "10,15,20,25,30,35,40,50"},
    {"silo", "bodies", "200", "10,15,20,25,30,35,40,50"},
};

RunOptions options_of(const Source& source, std::uint64_t seed) {
  RunOptions options = parse_run_options({{"scene", source.scene},
                                          {source.size, source.count},
                                          {"solver", "exact"},
                                          {"repeats", "1"},
                                          {"seed", std::to_string(seed)},
                                          {"out", "-"}});
  options.at = parse_integers("--at", source.at, {0, 1e6});
  options.steps = options.at.back() + 1;
  return options;
}

}  // namespace

std::vector<CalibrationProblem> recorded_problems(const std::vector<std::string>& files) {
  std::vector<CalibrationProblem> problems;
  for (const std::string& path : files) {
    ProblemFile file = read_problem_file_aloud(path);
    if (file.problem.row_count() == 0)
      throw std::invalid_argument("FILES: " + path +
                                  ": has no constraint row, so that there is nothing to time");
    std::vector<double> position_m = known_positions(file);
    problems.push_back({path, std::move(file.problem), std::move(position_m)});
  }
  return problems;
}

std::vector<CalibrationProblem> simulated_problems(std::uint64_t seed) {
  std::vector<CalibrationProblem> problems;
  ProgressLine line("simulating");
  int done = 0;
  for (const Source& source : kSources) {
    const std::string name = std::string(source.scene) + " --" + source.size + " " + source.count;
    const auto keep = [&](const ObservedStep& step) {
      if (!step.rows.empty()) problems.push_back({name, step.problem, step.context.position_m});
    };
    Simulation(options_of(source, seed), stop_requested(), keep).run([](auto) {}, [](auto...) {});
    line.update(++done, static_cast<int>(std::size(kSources)));
  }
  return problems;
}

}  // namespace cleave
