#include "harness/commands/verify_file_rows.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <stdexcept>
#include <utility>
#include <vector>

#include "harness/base/hash.h"
#include "harness/base/numbers.h"
#include "harness/commands/stored_partition.h"
#include "harness/commands/turned_problem.h"
#include "harness/commands/verify_problem_file.h"
#include "harness/commands/verify_row_sums.h"
#include "harness/experiment/cell_measures.h"
#include "harness/experiment/friction.h"
#include "harness/experiment/friction_mismatch.h"
#include "harness/experiment/problem_graph.h"
#include "harness/experiment/splitter.h"
#include "harness/experiment/step_columns.h"
#include "harness/experiment/step_record.h"
#include "harness/files/manifest.h"
#include "solver/problem_hash.h"
#include "solver/residual.h"
#include "solver/vertex_cover.h"

namespace cleave {
namespace {

namespace fs = std::filesystem;

constexpr const char* kProblemColumns[] = {
    "scene",       "seed",          "step",    "friction",     "bodies", "contacts", "rows", "rows_bilateral",
    "rows_normal", "rows_friction", "islands", "problem_hash", "dt_s",   "cfm",      "erp",  "time_s"};
constexpr const char* kPartitionColumns[] = {"parts",          "max_part_bodies",    "cut_pairs",
                                             "interface_rows", "interface_bodies",   "interface_cover_bodies",
                                             "contiguous",     "part_mass_ratio_max"};
constexpr const char* kGrownColumns[] = {
    "parts_before",          "max_part_bodies_before",  "cut_pairs_before",
    "interface_rows_before", "interface_bodies_before", "contiguous_before"};
constexpr const char* kResidualColumns[] = {"residual_m_per_s", "residual_bilateral_m_per_s",
                                            "residual_normal_m_per_s", "residual_friction_m_per_s",
                                            "residual_relative"};

constexpr double kEnergyTolerance = 1e-9;

// The file a row speaks of: beside steps.csv, or where it was when it was read.
fs::path problem_path(const fs::path& directory, const std::string& name) {
  std::error_code error;
  const fs::path beside = directory / fs::path(name).filename();
  if (fs::exists(beside, error)) return beside;
  return fs::exists(name, error) ? fs::path(name) : fs::path();
}

// The model that a replay gave to its problems; empty: as recorded. A name that is none is told among the
// options.
std::string replayed_friction(const StoredManifest& manifest) {
  const std::string name = manifest.command == "replay" ? manifest.option("friction") : "";
  return std::ranges::count(recorded_friction_models(), name) > 0 ? name : "";
}

// One row against the row computed anew.
class RowCheck {
 public:
  RowCheck(const StepsTable& table, std::size_t row) : table_(table), row_(row) {}

  // Texts must be the same, and numbers are printed so that equal ones are.
  template <std::size_t N>
  void same_cells(const StepRecord& found, const char* const (&columns)[N]) {
    const std::map<std::string, std::string> cells = cells_of(found);
    for (const char* column : columns) same_text(column, cells.at(column));
  }

  // Sums of floating-point numbers, which another compiler may round differently.
  void same_number(const char* column, double found, double scale = 0) {
    const double stored = table_.number(row_, column);
    note(same_residual(stored, found) || std::abs(stored - found) <= kEnergyTolerance * scale, column,
         table_.cell(row_, column), number_text(found));
  }

  // Whether the model left nothing out of the last solve.
  bool solved_all_rows() const { return cleave::solved_all_rows(table_, row_); }

  // Whether the solver analysed this problem: not an earlier step's, and not what the model left of it.
  bool analysed_alone() const {
    return solved_all_rows() && table_.cell(row_, "reuse_analysis") != "1" &&
           table_.cell(row_, "session") != "1";
  }

  void same_text(const char* column, const std::string& found) {
    note(table_.cell(row_, column) == found, column, table_.cell(row_, column), found);
  }

  void same_residuals(const ResidualReport& verdict) {
    const double found[] = {verdict.residual_m_per_s, verdict.residual_bilateral_m_per_s,
                            verdict.residual_normal_m_per_s, verdict.residual_friction_m_per_s,
                            verdict.residual_relative};
    for (std::size_t i = 0; i < std::size(found); ++i) same_number(kResidualColumns[i], found[i]);
    const std::string& status = table_.cell(row_, "status");
    note(has_result(status), "status", status, "a solution");
    note(status != "ok" || verdict.exact, "status", status, "a residual above the limit");
    // Differences of energies are as exact as the energies.
    const double scale_j = std::max(1.0, verdict.kinetic_energy_j);
    same_number("largest_free_velocity_m_per_s", verdict.largest_free_velocity_m_per_s);
    same_number("kinetic_energy_j", verdict.kinetic_energy_j, scale_j);
    same_number("energy_excess_j", verdict.energy_excess_j, scale_j);
  }

  void note(bool same, const std::string& column, const std::string& stored, const std::string& found) {
    ++compared_;
    if (!same) differences_ += "; " + column + " = " + stored + ", computed anew: " + found;
  }

  void finish(const std::string& subject, const std::string& text, CheckList& list) const {
    list.add(differences_.empty(), subject,
             text + ": " + std::to_string(compared_) + " columns" + differences_);
  }

 private:
  const StepsTable& table_;
  std::size_t row_;
  int compared_ = 0;
  std::string differences_;
};

StepRecord row_of_file(const ProblemFile& file) {
  StepRecord row;
  row.scene = file.scene;
  row.seed = file.seed;
  row.step = file.step;
  row.friction = file.friction_model;
  row.dt_s = file.problem.h_s;
  row.time_s = file.step * file.problem.h_s;
  row.cfm = file.cfm;
  row.erp = file.erp;
  set_problem_columns(file.problem, row);
  return row;
}

// The parts before they were refined, where they can be made again; the check of the file says where not.
void check_grown(const ProblemFile& file, const StoredPartition& partition, StepRecord& found,
                 RowCheck& check) {
  if (content_of("partitioner", algorithm_name(partition.partitioner)) != nullptr) return;
  try {
    if (read_origin(partition) != PartitionOrigin::fresh) return;
    const Split split = Splitter(read_split_setup(partition))
                            .run(file.problem, file.step, {known_positions(file), known_groups(file)});
    found.set_partition_before(measure_partition(split.graph, split.before.part_of_body));
  } catch (const std::invalid_argument&) {
    return;
  } catch (const CannotSplit&) {
    return;
  }
  check.same_cells(found, kGrownColumns);
}

// A word that is none is named by the check of the file.
void check_origin(const StoredPartition& partition, RowCheck& check) {
  try {
    check.same_text("partition_origin", to_string(read_origin(partition)));
  } catch (const std::invalid_argument&) {
    check.same_text("partition_origin", "a word that is none");
  }
}

// Six for each body of the cover that schur-bodies takes.
int cover_unknowns(const StepProblem& problem, const std::vector<int>& parts) {
  const BodyGraph graph = body_graph_of(problem);
  std::vector<std::pair<int, int>> cut_pairs;
  for (int body = 0; body < graph.body_count(); ++body)
    for (const int other : graph.neighbours(body))
      if (body < other && parts[body] != parts[other]) cut_pairs.emplace_back(body, other);
  return 6 * static_cast<int>(std::ranges::count(vertex_cover(graph.body_count(), cut_pairs), 1));
}

void check_measures(const ProblemFile& file, const StoredSolution& stored, const std::vector<int>& parts,
                    const ResidualReport& verdict, RowCheck& check) {
  const BodyGraph graph = body_graph_of(file.problem);
  const Solution solution{stored.impulse, stored.velocity};
  const Cell cell{file.problem, parts.empty() ? nullptr : &graph, parts, solution, verdict};
  for (const CellMeasure& measure : cell_measures()) check.same_number(measure.name, measure.value(cell));
}

void check_solved_row(const ProblemFile& file, const std::string& label, const std::string& status,
                      StepRecord& found, RowCheck& check) {
  const StoredSolution& solution = file.solutions.at(label);
  const ResidualReport verdict = judge(file.problem, solution.impulse);
  check.same_residuals(verdict);
  const FrictionMismatch mismatch = friction_mismatch(file.problem, solution.impulse);
  check.same_number("bound_mismatch", mismatch.bound_mismatch);
  check.same_number("friction_beyond_share", mismatch.friction_beyond_share);
  check.same_text("strategy", solution.strategy);
  check.same_text("kernel", solution.kernel);
  const auto partition = file.partitions.find(label);
  std::vector<int> parts;
  if (partition != file.partitions.end()) {
    parts = partition->second.part_of_body;
    // Nothing can be counted with ids that are none; the check of the file has named them.
    if (find_bad_part_id(parts) >= 0) return check.same_text("parts", "ids that are none");
    found.set_partition(measure_partition(body_graph_of(file.problem), parts));
    check.same_cells(found, kPartitionColumns);
    check_grown(file, partition->second, found, check);
    check_origin(partition->second, check);
    const std::string choice = read_choice(partition->second);
    check.same_text("auto_choice", choice.empty() ? "-" : choice);
    // A solver that says schur-rows and works on something else is found out by its interface.
    if (solution.kernel == "schur-rows" && check.solved_all_rows())
      check.same_text("interface_unknowns", std::to_string(found.interface_rows));
    if (solution.kernel == "schur-bodies" && check.analysed_alone())
      check.same_text("interface_unknowns", std::to_string(cover_unknowns(file.problem, parts)));
  }
  if (has_result(status)) check_measures(file, solution, parts, verdict, check);
  check.same_text("solution_hash", hex(solution_hash(solution.impulse, parts)));
}

void check_row(const StepsTable& table, std::size_t row, const ProblemFile& file, const fs::path& path,
               bool needs_solution, const std::string& subject, CheckList& list) {
  const std::string label = combination_label(table.cell(row, "partitioner"), table.cell(row, "refiner"),
                                              table.cell(row, "solver"));
  const std::string& status = table.cell(row, "status");
  const bool solved = file.solutions.contains(label);
  RowCheck check(table, row);
  StepRecord found = row_of_file(file);
  check.same_cells(found, kProblemColumns);
  if (solved) check_solved_row(file, label, status, found, check);
  if (needs_solution && has_result(status)) {
    check.note(solved, "solution", label, "none in the file");
    const bool has_parts = table.cell(row, "partitioner") != "-";
    check.note(file.partitions.contains(label) == has_parts, "partition", label,
               has_parts ? "none in the file" : "one in the file");
  }
  check.finish(subject, label + " against the " + (solved ? "solution" : "problem") + " in " + path.string(),
               list);
}

}  // namespace

void check_file_rows(const fs::path& directory, const StepsTable& table, const StoredManifest& manifest,
                     CheckList& list) {
  const bool needs_solutions = manifest.option("write-solutions") == "true";
  const std::string friction = replayed_friction(manifest);
  fs::path open;
  ProblemFile file;
  std::size_t without = 0;
  for (std::size_t row = 0; row < table.row_count(); ++row) {
    const std::string& name = table.cell(row, "problem_file");
    const std::string subject = (directory / kStepsFile).string() + " " + StepsTable::line_of(row);
    if (name == "-") {
      ++without;
      continue;
    }
    const fs::path problem = problem_path(directory, name);
    list.add(!problem.empty(), subject, "problem file " + name + (problem.empty() ? " is not there" : ""));
    if (problem.empty()) continue;
    if (problem != open) {
      file = read_problem_file(problem);
      turn_friction(problem, friction, file);
    }
    open = problem;
    check_row(table, row, file, problem, needs_solutions, subject, list);
  }
  if (without > 0)
    CheckList::note((directory / kStepsFile).string(), std::to_string(without) + " of " +
                                                           std::to_string(table.row_count()) +
                                                           " rows have no problem file to compare with");
}

}  // namespace cleave
