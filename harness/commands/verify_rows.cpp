#include "harness/commands/verify_rows.h"

#include <algorithm>
#include <cstdio>
#include <optional>
#include <vector>

#include "harness/base/hash.h"
#include "harness/commands/verify_table.h"
#include "harness/experiment/friction.h"
#include "harness/experiment/problem_graph.h"
#include "harness/experiment/step_columns.h"
#include "harness/experiment/step_record.h"
#include "solver/problem_hash.h"
#include "solver/residual.h"

namespace cleave {
namespace {

namespace fs = std::filesystem;

constexpr const char* kProblemColumns[] = {
    "scene",       "seed",          "step",    "friction",     "bodies", "contacts", "rows", "rows_bilateral",
    "rows_normal", "rows_friction", "islands", "problem_hash", "dt_s",   "cfm",      "erp"};
constexpr const char* kPartitionColumns[] = {"parts",          "max_part_bodies",    "cut_pairs",
                                             "interface_rows", "interface_bodies",   "interface_cover_bodies",
                                             "contiguous",     "part_mass_ratio_max"};
constexpr const char* kResidualColumns[] = {"residual_m_per_s", "residual_bilateral_m_per_s",
                                            "residual_normal_m_per_s", "residual_friction_m_per_s",
                                            "residual_relative"};

// The file a row speaks of: beside steps.csv, or where it was when it was read.
fs::path problem_path(const fs::path& directory, const std::string& name) {
  std::error_code error;
  if (name == "-") return {};
  const fs::path beside = directory / fs::path(name).filename();
  if (fs::exists(beside, error)) return beside;
  return fs::exists(name, error) ? fs::path(name) : fs::path();
}

// One row against the row computed anew.
class RowCheck {
 public:
  RowCheck(const StepsTable& table, std::size_t row) : table_(table), row_(row) {}

  // Texts must be the same, and numbers are printed so that equal ones are.
  template <std::size_t N>
  void same_cells(const StepRecord& found, const char* const (&columns)[N]) {
    const std::vector<std::string> header = split_csv_line(csv_header());
    const std::vector<std::string> cells = split_csv_line(csv_line(found));
    for (const char* column : columns) {
      std::string cell = cells[std::ranges::find(header, column) - header.begin()];
      if (!cell.empty() && cell.back() == '\n') cell.pop_back();
      note(table_.cell(row_, column) == cell, column, table_.cell(row_, column), cell);
    }
  }

  void same_residuals(const ResidualReport& verdict) {
    const double found[] = {verdict.residual_m_per_s, verdict.residual_bilateral_m_per_s,
                            verdict.residual_normal_m_per_s, verdict.residual_friction_m_per_s,
                            verdict.residual_relative};
    for (std::size_t i = 0; i < std::size(found); ++i) {
      const double stored = table_.number(row_, kResidualColumns[i]);
      note(same_residual(stored, found[i]), kResidualColumns[i], table_.cell(row_, kResidualColumns[i]),
           std::to_string(found[i]));
    }
    const std::string& status = table_.cell(row_, "status");
    note(status != "ok" || verdict.exact, "status", status, "a residual above the limit");
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
  row.cfm = file.cfm;
  row.erp = file.erp;
  set_problem_columns(file.problem, row);
  return row;
}

void check_solved_row(const StepsTable& table, std::size_t row, const ProblemFile& file,
                      const std::string& label, StepRecord& found, RowCheck& check) {
  const StoredSolution& solution = file.solutions.at(label);
  check.same_residuals(judge(file.problem, solution.impulse));
  const auto partition = file.partitions.find(label);
  std::vector<int> parts;
  if (partition != file.partitions.end()) {
    parts = partition->second.part_of_body;
    // Nothing can be counted with ids that are none; the check of the file has named them.
    if (find_bad_part_id(parts) >= 0) return check.note(false, "parts", table.cell(row, "parts"), "-");
    found.set_partition(measure_partition(body_graph_of(file.problem), parts));
    check.same_cells(found, kPartitionColumns);
    // A solver that says schur-rows and works on something else is found out by its interface.
    const std::string& unknowns = table.cell(row, "interface_unknowns");
    const std::string cut = std::to_string(found.interface_rows);
    if (table.cell(row, "kernel") == "schur-rows")
      check.note(unknowns == cut, "interface_unknowns", unknowns, cut);
  }
  const std::string hash = hex(solution_hash(solution.impulse, parts));
  check.note(table.cell(row, "solution_hash") == hash, "solution_hash", table.cell(row, "solution_hash"),
             hash);
}

void check_row(const StepsTable& table, std::size_t row, const ProblemFile& file, const fs::path& path,
               const std::string& subject, CheckList& list) {
  const std::string label = combination_label(table.cell(row, "partitioner"), table.cell(row, "refiner"),
                                              table.cell(row, "solver"));
  const bool solved = file.solutions.contains(label);
  RowCheck check(table, row);
  StepRecord found = row_of_file(file);
  check.same_cells(found, kProblemColumns);
  if (solved) check_solved_row(table, row, file, label, found, check);
  check.finish(subject, label + " against the " + (solved ? "solution" : "problem") + " in " + path.string(),
               list);
}

void check_limits(const StepsTable& table, const std::string& subject, CheckList& list) {
  std::size_t ok = 0;
  std::string wrong;
  for (std::size_t row = 0; row < table.row_count(); ++row) {
    if (table.cell(row, "status") != "ok") continue;
    ++ok;
    const double limit = kExactLimit * std::max(1.0, table.number(row, "largest_free_velocity_m_per_s"));
    if (wrong.empty() && !(table.number(row, "residual_m_per_s") <= limit))
      wrong = "; line " + std::to_string(row + 2) + " says ok with a residual of " +
              table.cell(row, "residual_m_per_s") + " m/s";
  }
  list.add(wrong.empty(), subject,
           std::to_string(ok) + " of " + std::to_string(table.row_count()) +
               " rows say ok, all within the limit" + wrong);
}

}  // namespace

void check_steps_table(const fs::path& directory, CheckList& list) {
  const fs::path path = directory / "steps.csv";
  const StepsTable table(path);
  check_limits(table, path.string(), list);
  fs::path open;
  ProblemFile file;
  std::size_t without = 0;
  for (std::size_t row = 0; row < table.row_count(); ++row) {
    const fs::path problem = problem_path(directory, table.cell(row, "problem_file"));
    if (problem.empty() || table.cell(row, "status") == "skipped") {
      ++without;
      continue;
    }
    if (problem != open) file = read_problem_file(problem);
    open = problem;
    check_row(table, row, file, problem, path.string() + " line " + std::to_string(row + 2), list);
  }
  if (without > 0)
    std::fprintf(stderr, "%s: %zu of %zu rows have no problem file to compare with\n", path.c_str(), without,
                 table.row_count());
}

}  // namespace cleave
