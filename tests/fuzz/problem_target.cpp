// Problem files as verify, replay and export read them.
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <optional>

#include "harness/experiment/friction_cone.h"
#include "harness/experiment/friction_mismatch.h"
#include "harness/experiment/problem_graph.h"
#include "harness/files/problem_file.h"
#include "solver/problem_hash.h"
#include "solver/residual.h"
#include "tests/fuzz/child_reports.h"
#include "tests/fuzz/problem_image.h"
#include "tests/fuzz/scratch_file.h"
#include "tests/fuzz/scratch_folder.h"
#include "tests/fuzz/target.h"

namespace cleave::fuzz {
namespace {

namespace fs = std::filesystem;

std::string bytes_of(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

std::string written(const ProblemFile& file) {
  static const ScratchFolder folder;
  const fs::path path = folder.path() / "again.h5";
  write_problem_file(path, file);
  return bytes_of(path);
}

// What everything that takes a problem relies on.
void use_problem(StepProblem problem, const std::vector<double>& impulse) {
  problem_hash(problem);
  body_graph_of(problem);
  judge(problem, impulse);
  friction_mismatch(problem, impulse);
  for (const ContactSet set : {ContactSet::coulomb, ContactSet::box, ContactSet::cone}) {
    if (!turn_contacts(set, problem).empty()) return;
    judge(problem, impulse);
  }
}

void use_solutions(const ProblemFile& file) {
  for (const auto& [label, solution] : file.solutions) use_problem(file.problem, solution.impulse);
}

// The child that reads is there to be crashed by the HDF5 library; by this project's code it must not be.
void require_foreign_end(const std::string& reason) {
  const std::string report = take_child_report();
  require(!is_own_fault(report), "reading crashes in code of its own:\n" + report);
  require(reason.find("SIGABRT") == std::string::npos, "reading ends by a broken assertion: " + reason);
}

}  // namespace

void read_problem(std::string_view recipe) {
  const ScratchFile file(problem_image(recipe));
  std::optional<ProblemFile> problem;
  std::string reason;
  if (refuses([&] { problem = read_problem_file(file.path()); }, &reason)) {
    require_foreign_end(reason);
    return;
  }
  const std::string first = written(*problem);
  require(written(read_problem_file(ScratchFile(first).path())) == first, "a file is read as another one");
  use_problem(problem->problem, problem->problem.warm_impulse);
  use_solutions(*problem);
}

}  // namespace cleave::fuzz
