#include "harness/commands/verify_row_sums.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <type_traits>

#include "harness/base/algorithm.h"
#include "harness/base/names.h"
#include "harness/base/numbers.h"
#include "harness/experiment/chosen_kernel.h"
#include "harness/experiment/splitter.h"
#include "harness/experiment/step_record.h"
#include "partition/partition.h"
#include "solver/registry.h"
#include "solver/step_problem.h"
#include "solver/step_solver.h"

namespace cleave {
namespace {

template <class Number>
bool reads_as(const std::string& cell) {
  Number value{};
  return read_whole(cell, value);
}

// By column: whether a cell reads as what the column holds.
std::map<std::string, bool (*)(const std::string&)> readers() {
  std::map<std::string, bool (*)(const std::string&)> readers;
  visit_fields(StepRecord{},
               [&]<class Value>(std::string_view name, const Value&, const char*, ColumnOf, About) {
                 if constexpr (std::is_arithmetic_v<Value>) readers.emplace(name, reads_as<Value>);
               });
  return readers;
}

// Measured only where a solve returned something; `-` or nan elsewhere.
constexpr const char* kOfResult[] = {"t_s_ms",           "t_s_min_ms",       "t_s_max_ms",
                                     "t_s_other_ms",     "residual_m_per_s", "largest_free_velocity_m_per_s",
                                     "kinetic_energy_j", "solution_hash"};
constexpr const char* kNanWhenDiverged[] = {"residual_m_per_s", "kinetic_energy_j"};

// One row; what is wrong goes to the findings with its line.
class RowAlone {
 public:
  RowAlone(const StepsTable& table, std::size_t row, Findings& findings)
      : table_(table), row_(row), findings_(findings) {}

  void check() {
    check_status();
    check_sizes();
    check_partition();
    if (!has_result(text("status"))) return;
    check_kernel();
    check_model();
    check_times();
    check_residuals();
  }

 private:
  const std::string& text(const std::string& column) const { return table_.cell(row_, column); }
  double number(const std::string& column) const { return table_.number(row_, column); }

  void require(bool holds, const std::string& column, const std::string& wanted) {
    if (!holds)
      findings_.add(StepsTable::line_of(row_) + ": " + column + " = " + text(column) +
                    ", allowed: " + wanted);
  }

  // A cell that must be another number of the row, NaN among them.
  void require_equal(const std::string& column, double wanted) {
    const double stored = number(column);
    require(stored == wanted || (std::isnan(stored) && std::isnan(wanted)), column, number_text(wanted));
  }

  void check_status() {
    const std::string& status = text("status");
    const bool result = has_result(status);
    require(find_status(status).has_value(), "status", joined(status_names(), ", "));
    for (const char* column : kOfResult) {
      if (status == "diverged" && std::ranges::count(kNanWhenDiverged, std::string(column)) > 0) continue;
      require((text(column) != "nan" && text(column) != "-") == result, column,
              std::string(result ? "measured" : "unmeasured") + " where status is " + status);
    }
    if (status == "ok") require(text("status_reason") == "-", "status_reason", "- where status is ok");
    if (!result || status == "ok" || text("status_reason") != "-") return;
    require(!residual_is_exact(table_, row_), "status",
            "ok, as the residual is within the limit and no reason is given");
  }

  void check_sizes() {
    if (text("status") == "skipped") return require_equal("rows", -1);
    require_equal("rows", number("rows_bilateral") + number("rows_normal") + number("rows_friction"));
    require_equal("contacts", number("rows_normal"));
  }

  void check_partition() {
    static const std::vector<std::string> both = {"parts",          "max_part_bodies",  "cut_pairs",
                                                  "interface_rows", "interface_bodies", "contiguous"};
    if (text("partitioner") == "-") {
      for (const std::string& column : both)
        for (const std::string& counted : {column, column + "_before"}) require_equal(counted, -1);
      require_equal("interface_cover_bodies", -1);
      require(text("partition_origin") == "-", "partition_origin", "- where nothing is split");
      for (const char* column :
           {"part_mass_ratio_max", "t_graph_ms", "t_partition_ms", "t_refine_ms", "t_pr_ms"})
        require_equal(column, kUnmeasured);
    }
    if (number("parts") <= 0) return;
    check_origin();
    // What is repaired is moved without a refiner, and what is kept is not moved.
    const std::string& origin = text("partition_origin");
    if (origin == "kept" || (origin != "repaired" && text("refiner") == "none"))
      for (const std::string& column : both) require_equal(column + "_before", number(column));
    check_interface();
  }

  // Rows that were left out of the last solve are in the partition and not in its interface.
  void check_interface() {
    const bool is_full = solved_all_rows(table_, row_);
    const double unknowns = number("interface_unknowns");
    if (unknowns == -1 && text("status") == "out_of_memory") return;  // not measured: refused before
    if (text("kernel") == "schur-rows") {
      const double most = number("interface_rows");
      require(is_full ? unknowns == most : unknowns <= most, "interface_unknowns",
              (is_full ? "" : "at most ") + number_text(most));
    }
    // The solver's cover is a least one where the cut pairs form a bipartite graph, the counted one is
    // greedy. An analysis that is kept keeps its cover, of a step that had other cut pairs.
    if (text("kernel") == "schur-bodies" && text("reuse_analysis") != "1" && number("session") != 1) {
      const double most = 6 * number("interface_cover_bodies");
      require(unknowns <= most && std::fmod(unknowns, 6) == 0 && (!is_full || (unknowns > 0) == (most > 0)),
              "interface_unknowns", "a multiple of 6, at most " + number_text(most));
    }
  }

  // Kernel `chosen` is the one for which the parts were chosen.
  void check_kernel() {
    if (solver_halves(algorithm_name(text("solver"))).kernel != kChosenKernel) return;
    const std::string_view wanted = kernel_of_choice(text("auto_choice"));
    require(text("kernel") == wanted, "kernel", std::string(wanted) + ", as auto_choice says");
  }

  // Every pass after the first one is for rows that came back.
  void check_model() {
    const double passes = number("model_passes"), returned = number("model_rows_returned");
    const double left_out = number("model_rows_left_out") + number("model_rows_at_rest");
    if (text("model") == "full")
      for (const char* column : {"model_rows_left_out", "model_rows_at_rest", "model_rows_returned"})
        require_equal(column, 0);
    require(left_out <= number("rows"), "model_rows_left_out", "with those at rest at most the rows");
    require(returned <= left_out, "model_rows_returned", "at most those left out and at rest");
    require((passes > 1) == (returned > 0) && passes >= 1 && passes <= kMostPasses, "model_passes",
            "more than 1 where rows returned, at most " + std::to_string(kMostPasses));
  }

  void check_origin() {
    const bool anew = text("repartition") == "always" || text("repartition") == "every:1";
    const std::string& origin = text("partition_origin");
    require(anew ? origin == "fresh" : find_origin(origin).has_value(), "partition_origin",
            anew ? "fresh, as repartition is " + text("repartition") : "fresh, repaired, kept");
  }

  void check_times() {
    double other_ms = number("t_s_ms");
    for (const std::string_view stage : kStageNames) other_ms -= number("t_s_" + std::string(stage) + "_ms");
    require_equal("t_s_other_ms", other_ms);
    require(number("t_s_min_ms") <= number("t_s_ms"), "t_s_min_ms", "at most t_s_ms");
    require(number("t_s_max_ms") >= number("t_s_ms"), "t_s_max_ms", "at least t_s_ms");
    const double repeats = number("repeat_count");
    // The median of two is the lower one.
    if (repeats <= 2) require_equal("t_s_min_ms", number("t_s_ms"));
    if (repeats != 1) return;
    require_equal("t_s_max_ms", number("t_s_ms"));
    require_equal("t_pr_ms", number("t_partition_ms") + number("t_refine_ms"));
  }

  void check_residuals() {
    if (std::isnan(number("residual_m_per_s"))) return;
    require_equal("residual_m_per_s",
                  std::max({number("residual_bilateral_m_per_s"), number("residual_normal_m_per_s"),
                            number("residual_friction_m_per_s")}));
  }

  const StepsTable& table_;
  std::size_t row_;
  Findings& findings_;
};

}  // namespace

bool residual_is_exact(const StepsTable& table, std::size_t row) {
  return table.number(row, "residual_m_per_s") <=
         kExactLimit * std::max(1.0, table.number(row, "largest_free_velocity_m_per_s"));
}

bool solved_all_rows(const StepsTable& table, std::size_t row) {
  return table.number(row, "model_rows_left_out") + table.number(row, "model_rows_at_rest") ==
         table.number(row, "model_rows_returned");
}

bool check_cells(const StepsTable& table, const std::string& subject, CheckList& list) {
  Findings findings;
  for (const auto& [column, reads] : readers())
    for (std::size_t row = 0; row < table.row_count(); ++row)
      if (!reads(table.cell(row, column)))
        findings.add(StepsTable::line_of(row) + ": " + column + " = '" + table.cell(row, column) +
                     "', allowed: a number");
  list.add(findings.none(), subject, "every cell reads as what its column holds" + findings.text());
  return findings.none();
}

void check_rows_alone(const StepsTable& table, const std::string& subject, CheckList& list) {
  Findings findings;
  for (std::size_t row = 0; row < table.row_count(); ++row) RowAlone(table, row, findings).check();
  list.add(findings.none(), subject, "sums, orders and statuses within each row" + findings.text());
}

}  // namespace cleave
