#include "harness/commands/verify_problem_file.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>
#include <regex>
#include <stdexcept>

#include "harness/base/hash.h"
#include "harness/base/numbers.h"
#include "harness/base/refusals.h"
#include "harness/base/value_spans.h"
#include "harness/commands/stored_partition.h"
#include "harness/experiment/algorithms.h"
#include "harness/experiment/friction.h"
#include "harness/experiment/problem_graph.h"
#include "harness/experiment/splitter.h"
#include "harness/experiment/step_columns.h"
#include "partition/part_file.h"
#include "solver/problem_hash.h"
#include "solver/residual.h"

namespace cleave {
namespace {

// Another compiler may round the judge's sums differently: far below the limit that decides.
constexpr double kResidualTolerance_m_per_s = 1e-12;
constexpr double kResidualRelativeTolerance = 1e-6;

void check_solution_label(const std::string& label, const StoredSolution& solution,
                          const std::string& subject, CheckList& list) {
  const std::string expected = combination_label(solution.partitioner, solution.refiner, solution.solver);
  list.add(label == expected, subject, "label of partitioner, refiner and solver " + expected);
}

void check_solution(const StepProblem& problem, const StoredSolution& solution, const std::string& subject,
                    CheckList& list) {
  const ResidualReport verdict = judge(problem, solution.impulse);
  list.add(same_residual(solution.residual_m_per_s, verdict.residual_m_per_s), subject,
           "residual " + number_text(verdict.residual_m_per_s) + " m/s, stored " +
               number_text(solution.residual_m_per_s));

  // Impulses that are no numbers have no velocity to compare with; their residual says so above.
  if (std::isnan(verdict.residual_m_per_s)) return;
  const double difference = largest_difference(solution.velocity, verdict.velocity);
  list.add(difference <= verdict.limit_m_per_s, subject,
           "velocity is v0 + M^-1 J^T impulse to " + number_text(difference) + " m/s");
}

bool check_part_ids(const StoredPartition& partition, const std::string& subject, CheckList& list) {
  const std::vector<int>& parts = partition.part_of_body;
  const int bad = find_bad_part_id(parts);
  list.add(bad < 0, subject,
           bad < 0 ? "part ids"
                   : "part_of_body[" + std::to_string(bad) + "] = " + std::to_string(parts[bad]) +
                         ", allowed: 0 to " + std::to_string(parts.size() - 1));
  return bad < 0;
}

std::string metrics_text(const PartitionMetrics& metrics) {
  return std::to_string(metrics.parts) + " parts, " + std::to_string(metrics.cut_pairs) + " cut pairs, " +
         std::to_string(metrics.interface_rows) + " interface rows";
}

// Parts that came from files, known by a fingerprint of the files alone. As they were in one file for all
// steps they can be compared with it; refined ones, and those of one file a step, cannot.
void check_outside_parts(const StoredPartition& partition, const std::string& counted,
                         const std::string& subject, CheckList& list) {
  const std::string fingerprint = fingerprint_of(partition.partitioner);
  static const std::regex form("(steps-)?[0-9a-f]{16}");
  std::string error;
  if (!std::regex_match(fingerprint, form))
    error = "; fingerprint of the files = '" + fingerprint + "', allowed: 16 hexadecimal digits";
  if (!partition.parent_of_part.empty())
    error += "; a tree of parts, allowed: one level, as parts from files are";
  error += wrong_in([&] { read_stored_refiner(partition); });
  list.add(error.empty(), subject, counted + "; from files, refiner " + partition.refiner + error);
  if (!error.empty()) return;
  if (fingerprint.starts_with("steps-") || partition.refiner != "none")
    return CheckList::note(subject, "the files are not here, so its parts cannot be made again");
  const std::string found = part_ids_fingerprint(partition.part_of_body);
  list.add(found == fingerprint, subject, "part ids have the fingerprint " + found + " of their file");
}

// Parts that hang on the steps before, which no file holds, are counted only. Whether there are such.
bool check_history(const StoredPartition& partition, const std::string& counted, const std::string& subject,
                   CheckList& list) {
  std::string origin;
  const std::string error = wrong_in([&] { origin = to_string(read_origin(partition)); });
  if (origin == to_string(PartitionOrigin::fresh)) return false;
  list.add(error.empty(), subject,
           counted + (error.empty() ? "; " + origin + " from the step before" : error));
  return true;
}

void check_split(const ProblemFile& file, const StoredPartition& partition, const std::string& subject,
                 CheckList& list) {
  const std::string counted =
      metrics_text(measure_partition(body_graph_of(file.problem), partition.part_of_body));
  if (check_history(partition, counted, subject, list)) return;
  if (content_of("partitioner", algorithm_name(partition.partitioner)) != nullptr)
    return check_outside_parts(partition, counted, subject, list);
  if (has_order_of_file(partition))
    return CheckList::note(
        subject, counted + "; the file of its body order is not here, so its parts cannot be made again");
  const auto not_again = [&](const std::exception& error) {
    list.add(false, subject, counted + "; cannot be split again: " + error.what());
  };
  Split again;
  try {
    again = Splitter(read_split_setup(partition))
                .run(file.problem, file.step, {known_positions(file), known_groups(file)});
  } catch (const std::invalid_argument& error) {
    return not_again(error);
  } catch (const CannotSplit& error) {
    return not_again(error);
  }
  const std::vector<int>& parts = again.parts.part_of_body;
  const int moved = static_cast<int>(std::inner_product(
      parts.begin(), parts.end(), partition.part_of_body.begin(), 0, std::plus<>(), std::not_equal_to<>()));
  const bool same_tree = again.parts.parent_of_part == partition.parent_of_part;
  list.add(moved == 0 && same_tree, subject,
           counted + "; split again, " +
               (moved > 0    ? std::to_string(moved) + " bodies differ"
                : !same_tree ? "the parts are the same and their tree is another"
                             : "the same"));
}

void check_partition(const std::string& label, const ProblemFile& file, const StoredPartition& partition,
                     const std::string& subject, CheckList& list) {
  const std::string pair = partition.partitioner + "+" + partition.refiner;
  list.add(label == pair || label.starts_with(pair + "+"), subject,
           "label of partitioner and refiner " + pair);
  if (check_part_ids(partition, subject, list)) check_split(file, partition, subject, list);
}

// A contact with friction whose set is not that of the model, in words; empty: there is none.
std::string find_other_set(const StepProblem& problem, const FrictionModelEntry& model) {
  for (int r = 0; r < problem.row_count(); ++r) {
    if (!(problem.friction_coefficient[r] > 0)) continue;
    const int normal = problem.friction_row[r];
    const ContactSet set = problem.contact_set.empty() ? ContactSet::box : problem.contact_set[normal];
    if (set != model.contact_set)
      return "; contact_set[" + std::to_string(normal) + "] = " + std::to_string(static_cast<int>(set)) +
             ", allowed: " + std::to_string(static_cast<int>(model.contact_set));
  }
  return {};
}

void check_friction_model(const ProblemFile& file, const std::string& subject, CheckList& list) {
  const std::string& model = file.friction_model;
  const std::string error = wrong_in([&] {
    const Algorithm named = read_named("friction", model, {{"friction-force-n", "0"}});
    return find_other_set(file.problem, friction_model(named.name));
  });
  list.add(error.empty(), subject, "friction_model " + model + error);
}

}  // namespace

bool same_residual(double stored_m_per_s, double found_m_per_s) {
  if (std::isnan(stored_m_per_s) || std::isnan(found_m_per_s))
    return std::isnan(stored_m_per_s) && std::isnan(found_m_per_s);
  if (stored_m_per_s == found_m_per_s) return true;  // infinities
  return std::abs(stored_m_per_s - found_m_per_s) <=
         kResidualTolerance_m_per_s + kResidualRelativeTolerance * std::abs(found_m_per_s);
}

int find_bad_part_id(const std::vector<int>& part_of_body) {
  const int bodies = static_cast<int>(part_of_body.size());
  const auto bad =
      std::ranges::find_if(part_of_body, [bodies](int part) { return part < 0 || part >= bodies; });
  return bad == part_of_body.end() ? -1 : static_cast<int>(bad - part_of_body.begin());
}

void check_problem_file(const std::filesystem::path& path, const ProblemFile& file, CheckList& list) {
  const StepProblem& problem = file.problem;
  CheckList::note(path.string(), "problem of " + file.scene + " step " + std::to_string(file.step) + ": " +
                                     std::to_string(problem.body_count()) + " bodies, " +
                                     std::to_string(problem.row_count()) + " rows, hash " +
                                     hex(problem_hash(problem)));
  if (file.friction_model != kUnknownProvenance) check_friction_model(file, path.string(), list);
  for (const auto& [label, solution] : file.solutions) {
    const std::string subject = path.string() + " solution/" + label;
    check_solution_label(label, solution, subject, list);
    check_solution(problem, solution, subject, list);
  }
  for (const auto& [label, partition] : file.partitions)
    check_partition(label, file, partition, path.string() + " partition/" + label, list);
}

}  // namespace cleave
