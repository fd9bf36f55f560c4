#include "harness/commands/turned_problem.h"

#include <algorithm>
#include <stdexcept>

#include "harness/experiment/friction.h"
#include "harness/experiment/friction_cone.h"
#include "solver/problem_hash.h"

namespace cleave {

bool turn_friction(const std::string& path, const std::string& model, ProblemFile& file) {
  if (model.empty()) return true;
  const std::uint64_t recorded = problem_hash(file.problem);
  const std::string error = turn_contacts(friction_model(model).contact_set, file.problem);
  if (!error.empty()) throw std::invalid_argument(path + ": cannot have --friction " + model + ": " + error);
  if (problem_hash(file.problem) == recorded)
    return std::ranges::any_of(file.problem.friction_row, [](int row) { return row >= 0; });
  file.friction_model = model;
  file.solutions.clear();
  file.partitions.clear();
  return true;
}

}  // namespace cleave
