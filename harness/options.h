// The options of a run and the one table they come from: the command line, --help, the manifest and the run
// id are all drawn from run_option_specs(). To add an option: a member of RunOptions and a row in
// options_table.cpp.
#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "harness/extract.h"
#include "harness/ode_baselines.h"
#include "partition/partitioner.h"
#include "partition/refiner.h"
#include "scenarios/scene.h"

namespace cleave {

// lockstep: all combinations solve the same problems and one solver advances the world.
// separate: one world per combination, each advanced by its own combination.
enum class RunMode { lockstep, separate };

struct RunOptions {
  std::string scene;
  std::vector<std::string> partitioners, refiners, solvers;
  std::string strategy, kernel;  // override that half of every solver's strategy:kernel; empty: as named
  std::string advance;           // solver that advances the world in lockstep
  RunMode mode = RunMode::lockstep;
  int steps = 500;
  int measure_every = 1;
  std::vector<int> at;  // ascending: measure these steps only (record); empty: measure_every decides
  int skip = 0;         // read by reports, not by the run
  int repeats = 3;
  int threads = 1;
  std::uint64_t seed = 1;
  std::string out;
  bool force = false;
  bool record_motion = false;
  bool reuse_analysis = false;
  int sweeps = 5;
  int predictor_sweeps = 40;
  int max_iterations = 100;
  OdeBaselineOptions ode_baseline;

  ExtractOptions extract;
  double stiffness_n_per_m = std::numeric_limits<double>::quiet_NaN();  // NaN: erp and cfm were given instead
  double damping_n_s_per_m = std::numeric_limits<double>::quiet_NaN();
  double gravity_m_per_s2 = 9.81;
  int contact_cap = 8;
  double match_tolerance = 0.05;

  PartitionOptions partition;
  double max_growth = 0.2;
  bool skip_small_islands = false;

  std::map<std::string, std::string> scene_options;  // of the scene, completed with its defaults

  RefineOptions refine() const {
    return {partition.max_bodies, max_growth, partition.edge_weight, partition.as_printed};
  }
};

// One option of the command line. The value is text on the way in and on the way out.
struct OptionSpec {
  enum class Kind { text, number, flag };
  std::string name;  // without dashes
  Kind kind;
  std::string placeholder;  // shown in --help; empty for a flag
  std::string help;         // one line, with the unit
  // Throws std::invalid_argument: "--mu: -1 is not in [0, inf)".
  std::function<void(RunOptions&, const std::string&)> set;
  std::function<std::string(const RunOptions&)> get;
};

std::span<const OptionSpec> run_option_specs();

// Throws std::invalid_argument: "--scene: 'rock_pil' is unknown; ...".
const SceneEntry& find_scene(const std::string& name);

// All partitioners and refiners, the paper's solver, and everything else as in RunOptions.
RunOptions default_run_options();

// Reads and checks given values by option name (flags: "true"); names outside the table are options of the
// scene.
// --stiffness k and --damping d together mean erp = h k / (h k + d) and cfm = 1 / (h k + d), with h = dt.
// Throws std::invalid_argument with one line naming the option, the value and the allowed range or choices.
RunOptions parse_run_options(const std::map<std::string, std::string>& given);

// The same for a command that solves without a scene; no option of a scene may be given.
RunOptions parse_solve_options(const std::map<std::string, std::string>& given);

// Every option with its value as text, the scene's after the table's; what the manifest holds.
struct OptionValue {
  std::string name;
  OptionSpec::Kind kind;
  std::string text;
};
std::vector<OptionValue> option_values(const RunOptions& options);

// Fingerprint of all options but threads, out, force, record-motion and the names of files: 16 hexadecimal
// digits.
std::string run_id(std::span<const OptionValue> values);
inline std::string run_id(const RunOptions& options) { return run_id(option_values(options)); }

}  // namespace cleave
