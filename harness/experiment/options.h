// The options of a run and the one table they come from: the command line, --help, the manifest and the run
// id are all drawn from run_option_specs(), from the parameters that algorithms declare (algorithms.h), and
// from the scene's. To add an option: a member of RunOptions and a row in options_table.cpp.
#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <map>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "harness/base/option_value.h"
#include "harness/experiment/algorithms.h"
#include "harness/experiment/body_order.h"
#include "harness/experiment/repartition.h"
#include "harness/world/extract.h"

namespace cleave {

// lockstep: all combinations solve the same problems and one solver advances the world.
// separate: one world per combination, each advanced by its own combination.
enum class RunMode { lockstep, separate };

// What refiners lower: the rows of the cut, or the modelled time of a solve (partition/cost_model.h).
enum class Objective { rows, cost };

// Which rows of a step are solved: all, or those that can matter to it (model_planner.h).
enum class Model { full, automatic };

struct RunOptions {
  Algorithm scene;
  std::vector<Algorithm> partitioners, refiners, solvers;
  Algorithm advance;             // solver that advances the world in lockstep
  Algorithm friction;            // its parameters are in `extract`
  std::string strategy, kernel;  // override that half of every solver's strategy:kernel; empty: as named
  CommonValues common;           // values given for all algorithms that have a parameter
  RunMode mode = RunMode::lockstep;
  Objective objective =
      Objective::rows;  // cost: partitioners and refiners by their twins of that objective, as fm-cost of fm
  int steps = 500;
  int measure_every = 1;
  std::vector<int> at;  // ascending: measure these steps only (record); empty: measure_every decides
  int skip = 0;         // read by reports, not by the run
  int repeats = 3;
  bool session = false;  // solvers carry what pays from step to step; each cell is then solved once
  Repartition repartition;
  BodyOrder body_order;
  Model model = Model::full;
  int threads = 1;
  double memory_limit_gb = std::numeric_limits<double>::quiet_NaN();             // NaN: what the machine has
  std::uint64_t memory_limit_bytes = std::numeric_limits<std::uint64_t>::max();  // what that is
  std::uint64_t seed = 1;
  std::string out;
  bool force = false;
  bool record_motion = false;
  bool explain_model = false;

  ExtractOptions extract;
  double stiffness_n_per_m = std::numeric_limits<double>::quiet_NaN();  // NaN: erp and cfm were given instead
  double damping_n_s_per_m = std::numeric_limits<double>::quiet_NaN();
  double gravity_m_per_s2 = 9.81;
  int contact_cap = 8;
  double match_tolerance = 0.05;
  bool skip_small_islands = false;

  std::vector<std::string> notes;   // what a keyword such as `all` does not name, what changes nothing
  std::vector<std::string> of_all;  // partitioners that stand for `all`, not named beside it
};

// Which commands have an option.
struct CommandSet {
  bool run, record, replay;
};
// Whether a command simulates a scene; replay has the problems of files.
inline bool has_world(bool CommandSet::*command) { return command != &CommandSet::replay; }

// One option of the command line. The value is text on the way in and on the way out. Lists of algorithms are
// kept as texts on the way in; parse_run_options reads them once all options are known.
struct OptionSpec {
  std::string name;  // without dashes
  OptionKind kind;
  std::string placeholder;  // shown in --help; empty for a flag
  std::string help;         // one line, with the unit
  About about;
  CommandSet commands;
  bool in_run_id;  // false: changes no row, such as --out
  // Throws std::invalid_argument: "--mu: -1 is not in [0, inf)".
  std::function<void(RunOptions&, const std::string&)> set;
  std::function<std::string(const RunOptions&)> get;
};

std::span<const OptionSpec> run_option_specs();
const OptionSpec* find_option(const std::string& name);  // nullptr: none

// The paper's partitioners and refiners on its solver, and everything else as in RunOptions.
RunOptions default_run_options();

// Reads and checks given values by option name (flags: "true"); names outside the table are parameters of
// algorithms or options of the scene.
// --stiffness k and --damping d together mean erp = h k / (h k + d) and cfm = 1 / (h k + d), with h = dt.
// stored: names in `given` that come from a manifest, which names all parameters; one that nothing in this
// run reads is then no mistake.
// Throws std::invalid_argument with one line naming the option, the value and the allowed range or choices.
RunOptions parse_run_options(const std::map<std::string, std::string>& given,
                             const std::set<std::string>& stored = {});

// The same for a command that solves without a scene; no option of a scene may be given.
RunOptions parse_solve_options(const std::map<std::string, std::string>& given,
                               const std::set<std::string>& stored = {});

}  // namespace cleave
