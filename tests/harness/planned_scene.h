// Scenes in which a test plans which rows are solved (harness/experiment/model_planner.h), stepped as a run
// steps them: named by options of the command line, or drawn at random.
#pragma once

#include <filesystem>
#include <fstream>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "harness/base/value_spans.h"
#include "harness/experiment/options.h"
#include "scenarios/scene.h"
#include "solver/residual.h"
#include "tests/harness/random_world.h"
#include "tests/harness/run_program.h"
#include "tests/harness/world_stepper.h"

namespace cleave {

struct PlannedScene {
  std::map<std::string, std::string> options;
  int steps;
  bool is_fast = false;  // bodies may spin at a hundred rad/s
};

inline WorldStepper stepper_of(const PlannedScene& scene) {
  std::map<std::string, std::string> given = scene.options;
  given["out"] = "none";
  const RunOptions options = parse_run_options(given);
  return {std::make_unique<OdeWorld>(scene_row(options.scene), options.scene.settings, options.seed,
                                     options.gravity_m_per_s2),
          options.extract};
}

// Stiff worlds and softer ones, with friction and without. The file bears the seed in its name, because a
// process reads a scene file once, whatever is written there later.
inline PlannedScene random_scene(int seed, int steps, const TemporaryDirectory& directory) {
  const std::filesystem::path path = directory / ("world" + std::to_string(seed) + ".toml");
  std::ofstream(path) << random_world(seed);
  return {{{"scene", "file@path=" + path.string()},
           {"cfm", seed % 2 == 0 ? "1e-5" : "1e-8"},
           {"mu", seed % 3 == 0 ? "0" : "0.5"}},
          steps,
          true};
}

inline std::vector<int> one_part(const StepProblem& problem) {
  return std::vector<int>(problem.body_count(), 0);
}

// By how much velocities of two solves of a step may differ, m/s: where bodies are fast, by as much as an
// exact answer may miss.
inline double same_velocity_m_per_s(bool is_fast, const ResidualReport& report) {
  return is_fast ? report.limit_m_per_s : kExactLimit;
}

}  // namespace cleave
