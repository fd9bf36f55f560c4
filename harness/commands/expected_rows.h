// The rows that the manifest of a directory promises, in their order, with all that its options decide of
// them.
#pragma once

#include <string>
#include <vector>

#include "harness/experiment/step_record.h"
#include "harness/files/manifest_reader.h"

namespace cleave {

class ExpectedRows {
 public:
  // Throws std::invalid_argument with one line for options that no run can have.
  explicit ExpectedRows(const StoredManifest& manifest);

  // Of a run that went through.
  std::size_t count() const { return problems_ * combinations_.size(); }

  // Names, parameters and options; of a step that a world simulated also its number and time. What a problem
  // file says of the step, and what was measured, is left unmeasured.
  StepRecord row(std::size_t index) const;

  // Which problem the row is of: all rows of one are side by side, but in --mode separate.
  std::size_t problem(std::size_t index) const;
  // Step or problem file, partitioner, refiner, solver, in words.
  std::string key(std::size_t index) const;

  bool is_replay() const { return is_replay_; }
  bool is_separate() const { return separate_; }

 private:
  void add_combinations(const StoredManifest& manifest);
  void read_steps(const StoredManifest& manifest);
  std::size_t combination(std::size_t index) const;

  StepRecord common_;
  std::vector<StepRecord> combinations_;  // names and parameters
  std::size_t problems_ = 0;
  std::vector<int> steps_;          // of the problems, where a world was simulated
  std::vector<std::string> files_;  // of the problems, where they lie in files
  bool is_replay_ = false, separate_ = false;
};

// "step 80 mix+fm+schur", of a row or what the cells of one say.
std::string row_key(const std::string& step_or_file, const std::string& partitioner,
                    const std::string& refiner, const std::string& solver);

// The run id that the options of the manifest give.
std::string run_id_of(const StoredManifest& manifest);

}  // namespace cleave
