// Small random problem files for tests, and a writer that writes what the real one would refuse.
#pragma once

#include <cstring>
#include <filesystem>
#include <functional>
#include <limits>
#include <random>
#include <stdexcept>
#include <string>
#include <vector>

#include "harness/files/hdf5_writer.h"
#include "harness/files/problem_file.h"
#include "harness/files/problem_file_fields.h"

namespace cleave {

class SampleRandom {
 public:
  explicit SampleRandom(std::uint64_t seed) : engine_(seed) {}
  double uniform() { return static_cast<double>(engine_() >> 11) * 0x1p-53; }
  double around_zero() { return 2 * uniform() - 1; }
  std::vector<double> numbers(std::size_t count) {
    std::vector<double> values(count);
    for (double& value : values) value = around_zero();
    return values;
  }

 private:
  std::mt19937_64 engine_;
};

// Bodies in a row, each with one joint row to the next, one contact with static geometry and its friction
// row.
inline StepProblem sample_problem(int bodies, std::uint64_t seed) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  SampleRandom random(seed);
  StepProblem p;
  p.h_s = 1.0 / 60;
  p.free_velocity = random.numbers(6 * bodies);
  p.mass.assign(36 * bodies, 0.0);
  for (int i = 0; i < bodies; ++i)
    for (int k = 0; k < 6; ++k) p.mass[36 * i + 7 * k] = 1 + random.uniform();
  const auto add = [&](int a, int b, RowKind kind, int normal, double lower, double upper, int constraint) {
    p.row_body.insert(p.row_body.end(), {a, b});
    p.row_kind.push_back(kind);
    p.friction_row.push_back(normal);
    p.friction_coefficient.push_back(kind == RowKind::friction ? 0.5 : 0);
    p.lower.push_back(lower);
    p.upper.push_back(upper);
    p.row_constraint.push_back(constraint);
    for (int k = 0; k < 12; ++k) p.jacobian.push_back(b < 0 && k >= 6 ? 0 : random.around_zero());
  };
  for (int i = 0; i + 1 < bodies; ++i) add(i, i + 1, RowKind::bilateral, -1, -kInfinity, kInfinity, i);
  for (int i = 0; i < bodies; ++i) {
    const int normal = static_cast<int>(p.lower.size());
    add(i, -1, RowKind::normal, -1, 0, kInfinity, bodies + i);
    add(i, -1, RowKind::friction, normal, -0.25, 0.25, bodies + i);
  }
  const std::size_t rows = p.lower.size();
  p.rhs = random.numbers(rows);
  p.compliance.assign(rows, 6e-4);
  p.contact_point = random.numbers(3 * rows);
  p.warm_impulse = random.numbers(rows);
  return p;
}

// The same with a cone and Coulomb's law in turn.
inline void give_sample_sets(StepProblem& p) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  p.contact_set.assign(p.row_count(), ContactSet::box);
  for (int r = 0; r < p.row_count(); ++r) {
    if (p.friction_row[r] < 0) continue;
    p.contact_set[p.friction_row[r]] = r % 4 == 1 ? ContactSet::cone : ContactSet::coulomb;
    p.lower[r] = -(p.upper[r] = kInfinity);
  }
}

inline ProblemShapes sample_shapes(int bodies, SampleRandom& random) {
  ProblemShapes shapes;
  for (int i = 0; i <= bodies; ++i) {
    shapes.geom_body.push_back(i < bodies ? i : -1);
    shapes.geom_type.push_back(static_cast<std::uint8_t>(i % 6));
    shapes.convex_first.push_back(shapes.convex_first.back() + (i % 6 == 4 ? 8 : 0));
  }
  shapes.geom_size.assign(3 * shapes.geom_body.size(), 0.5);
  shapes.geom_position = random.numbers(3 * shapes.geom_body.size());
  shapes.geom_orientation = random.numbers(4 * shapes.geom_body.size());
  shapes.convex_points = random.numbers(3 * shapes.convex_first.back());
  return shapes;
}

inline ProblemFile sample_file(int bodies = 5, std::uint64_t seed = 1) {
  SampleRandom random(seed + 1000);
  ProblemFile file;
  file.problem = sample_problem(bodies, seed);
  file.scene = "rock_pile";
  file.step = 17;
  file.seed = std::numeric_limits<std::uint64_t>::max() - seed;
  file.friction_model = "box-converged";
  file.erp = 0.2;
  file.cfm = 1e-5;
  file.position = random.numbers(3 * bodies);
  file.orientation = random.numbers(4 * bodies);
  file.body_group.emplace(bodies, 3);
  file.shapes = sample_shapes(bodies, random);
  StoredSolution solution{"schur", "pivot", "schur-rows", "mix", "fm", 1e-12, {}, {}};
  solution.impulse = random.numbers(file.problem.row_count());
  solution.velocity = random.numbers(6 * bodies);
  file.solutions["mix+fm+schur"] = solution;
  StoredPartition partition{"mix", "fm", {}, std::vector<int>(bodies, 0), {}};
  using Kind = Parameter::Kind;
  partition.parameters = {{"as_printed", Kind::flag, "true"},
                          {"edge_weight", Kind::word, "constraints"},
                          {"max_bodies", Kind::integer, "7"},
                          {"max_growth", Kind::number, "0.1"}};
  file.partitions["mix+fm+schur"] = partition;
  return file;
}

// Writes the parts that every file must have, without any check. instead: called with the name of every
// attribute and array; where it returns true it has seen to that one itself, or left it out.
using Instead = std::function<bool(const Hdf5Writer& writer, const std::string& name)>;
inline void write_unchecked(
    const std::filesystem::path& path, const ProblemFile& file,
    const Instead& instead = [](const Hdf5Writer&, const std::string&) { return false; }) {
  Hdf5Writer writer(path);
  if (!instead(writer, "schema")) writer.attribute("schema", problem_schema(file.problem));
  visit_attributes(file, [&](const std::string& name, const auto& value, Presence) {
    if (!instead(writer, name)) writer.attribute(name, value);
  });
  const std::size_t n = file.problem.body_count(), m = file.problem.row_count();
  visit_arrays(file, n, m,
               [&](const std::string& name, const auto& values, const Hdf5Shape& shape, Presence) {
                 if (!instead(writer, name)) writer.array(name, shape, values);
               });
  if (!file.problem.contact_set.empty() && !instead(writer, "contact_set"))
    writer.array("contact_set", {m}, file.problem.contact_set);
  if (file.shapes) {
    const Hdf5Writer group = writer.group("shape");
    visit_shape_arrays(*file.shapes, file.shapes->geom_body.size(), file.shapes->convex_points.size() / 3,
                       [&](const std::string& name, const auto& values, const Hdf5Shape& shape) {
                         group.array(name, shape, values);
                       });
  }
  instead(writer, "");  // whatever else there shall be
  writer.close();
}

// What reading the file says; empty where it is read.
inline std::string error_of(const std::filesystem::path& path) {
  try {
    read_problem_file(path);
    return "";
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
}

template <class Number>
bool same_bits(const std::vector<Number>& a, const std::vector<Number>& b) {
  return a.size() == b.size() &&
         (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(Number)) == 0);
}

}  // namespace cleave
