// Every registry of the program in one list: what a run can name, with which parameters. Options, --help,
// columns, run ids, problem files and the manifest are drawn from it; nothing else knows a name.
#pragma once

#include <map>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "harness/base/about.h"
#include "harness/base/algorithm.h"
#include "harness/world/step_context.h"
#include "scenarios/scene.h"
#include "solver/step_solver.h"

namespace cleave {

// One registry.
struct AlgorithmKind {
  const char* option;  // "partitioner": the option that names its rows, without dashes
  const char* plural;  // "partitioners": as `cleave list` calls it
  About about;         // of its parameters
  bool in_replay;      // a recorded problem can be given to it
  std::vector<AlgorithmEntry> entries;
  std::vector<std::string> names;  // all that the option takes; of solvers also every strategy:kernel
};

// Scenes, partitioners, refiners, solvers, ODE's own solvers, strategies, kernels, friction models.
std::span<const AlgorithmKind> algorithm_kinds();

// Values given for all algorithms that have a parameter (--max-bodies 30), by parameter.
using CommonValues = std::map<std::string, std::string>;

// All that an option can name, of all its kinds.
std::vector<std::string> names_for(const std::string& option);

// Throws std::invalid_argument when the text names no algorithm of that option.
void check_algorithm(const std::string& option, const std::string& text);

// Reads "mindp@max-bodies=50" for --option. Throws std::invalid_argument with one line: an unknown name (with
// the nearest one), a parameter of another algorithm (with its owner), a value that is not allowed, a file
// that is not what the algorithm reads. An algorithm that reads files is known by their content:
// "file@path=a.txt" has the text "file@1f2e3d4c5b6a7988".
Algorithm read_named(const std::string& option, const std::string& text, const CommonValues& common = {});

// Throws std::invalid_argument, naming the item, where the list has the algorithm already.
void append_once(const std::string& option, const std::string& item, Algorithm algorithm,
                 std::vector<Algorithm>& list);

// Reads a list: items as above, none twice, and where the kind has them the keywords
//     all     every algorithm of this build that needs no more than is given; what is left out goes to
//             `left_out`, in words. Options leave out partitioners too that the run's solvers cannot use
//     paper   those of Liu & Andrews 2022
std::vector<Algorithm> read_list(const std::string& option, const std::string& text,
                                 const CommonValues& common, std::vector<std::string>* left_out = nullptr);

// The parameters of a name of that option. Throws std::logic_error for a name that is none.
std::vector<Parameter> parameters_of(const std::string& option, const std::string& name);

// Fingerprints the files of an algorithm; null for one that reads none (AlgorithmEntry::content).
using ContentReader = std::string (*)(const Settings& settings);
ContentReader content_of(const std::string& option, const std::string& name);

// A parameter that is an option of its own: those of all kinds but scenes, whose parameters are options of
// scenes, and files, which belong to one algorithm at a time. Rows that share a name share the declaration.
struct CommonParameter {
  Parameter parameter;
  std::string owners;  // "partitioners mix; refiners kl, fm"
  About about;
  bool in_replay;
};
std::span<const CommonParameter> common_parameters();
const CommonParameter* find_common_parameter(const std::string& name);  // nullptr: none

// Who has a parameter, in words; empty: nobody.
std::string owners_of(const std::string& parameter);

const SceneEntry& scene_row(const Algorithm& scene);

// Whether the scene puts bodies into groups.
bool names_groups(const Algorithm& scene);

// Throws std::invalid_argument for an unknown name. context: see ode_baselines.h; must outlive the solver.
// ODE's own solvers cannot be stopped.
std::unique_ptr<StepSolver> make_solver(const Algorithm& solver, const SolveOptions& options,
                                        const StepContext& context);

// Whether it works on parts, so that partitioner and refiner matter to it.
bool uses_parts(const Algorithm& solver);

}  // namespace cleave
