// A recorded step problem in one HDF5 file (schemas "cleave-problem-1" and "-2"): all that a solver needs to
// solve the step again elsewhere, where the bodies were, and solutions that were found. n bodies, m
// constraint rows.
//
// PROBLEM_FILES.md says what is in it, what may be left out and which types are read; a program of 30 lines
// there writes one.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "harness/base/combination_label.h"
#include "harness/base/parameter.h"
#include "harness/base/shapes.h"
#include "solver/step_problem.h"

namespace cleave {

// The scene and friction model of a file that names none.
inline constexpr const char* kUnknownProvenance = "-";

struct StoredSolution {
  std::string solver, strategy, kernel, partitioner, refiner;  // partitioner and refiner "-": ignores parts
  double residual_m_per_s = 0;                                 // by the judge; NaN of a solve that diverged
  std::vector<double> impulse;                                 // (m) N s
  std::vector<double> velocity;                                // (n, 6)
};

// A parameter as an attribute: max_bodies, 25.
struct StoredParameter {
  std::string name;  // of the attribute
  Parameter::Kind kind;
  std::string text;
  bool operator==(const StoredParameter&) const = default;
};

struct StoredPartition {
  std::string partitioner, refiner;         // as named in the run
  std::vector<StoredParameter> parameters;  // what shaped it; see PROBLEM_FILES.md
  std::vector<int> part_of_body;            // (n)
  std::vector<int> parent_of_part;          // the tree (solver/parts.h); empty: one level
};

struct ProblemFile {
  StepProblem problem;
  std::string scene = kUnknownProvenance;
  int step = 0;
  std::uint64_t seed = 0;
  std::string friction_model = kUnknownProvenance;  // or one of friction_models()
  double erp = 0, cfm = 0;                          // of the world; joints may have their own
  std::vector<double> position;                     // (n, 3)
  std::vector<double> orientation;                  // (n, 4)
  std::optional<std::vector<int>> body_group;
  std::optional<ProblemShapes> shapes;
  std::map<std::string, StoredSolution> solutions;    // by label
  std::map<std::string, StoredPartition> partitions;  // by label
  bool is_checked = false;  // read from a file whose hashes bear out all of the above
};

// Throws std::invalid_argument with one line that names the file, what is wrong in it (dataset, index, value)
// and what is allowed: not a readable HDF5 file, wrong schema, missing parts, wrong types or shapes, values
// that are no problem (find_contents_error), contents that its own hashes do not bear out. Impulses,
// velocities and part ids of one level are checked for type and shape only: whether they are right is for
// `cleave verify` to say. Damage of whatever kind neither ends nor hangs the process: a child does the
// reading (isolated_read.h).
ProblemFile read_problem_file(const std::filesystem::path& path);

// The same, with a line on stderr where the file carries no hashes.
ProblemFile read_problem_file_aloud(const std::filesystem::path& path);

// Whatever ends the program, a file of this name is whole (whole_file.h). Throws std::invalid_argument for a
// problem that read_problem_file would refuse, and std::runtime_error naming the file and the reason when it
// cannot be written.
void write_problem_file(const std::filesystem::path& path, const ProblemFile& file);

// (n, 3) m, or empty where the file does not say where the bodies are: all positions are 0, which is what it
// means to leave them out.
std::vector<double> known_positions(const ProblemFile& file);

// (n) groups of bodies, or empty where the file names none.
std::vector<int> known_groups(const ProblemFile& file);

// "rock_pile_step000100.h5": what `record` calls the problem of a step.
std::string problem_file_name(const std::string& scene, int step);

}  // namespace cleave
