// Problems with everything that FCLIB takes, and FCLIB files read and written by the library of FCLIB's own.
#pragma once

#include <gtest/gtest.h>

extern "C" {
#include <fclib.h>
}

#include <Eigen/Dense>
#include <cstdlib>
#include <filesystem>
#include <memory>

#include "harness/files/fclib_file.h"
#include "tests/harness/problem_file_sample.h"

namespace cleave {

// Joints between neighbours, contacts with static geometry and of every other body, in turn: with Coulomb
// friction, without friction, and with tangents that carry nothing. Some rows have no compliance; mass blocks
// are full.
inline StepProblem fclib_sample(int bodies, int tangents, std::uint64_t seed) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  SampleRandom random(seed);
  StepProblem p;
  p.h_s = 1.0 / 60;
  p.free_velocity = random.numbers(6 * bodies);
  for (int i = 0; i < bodies; ++i) {
    Eigen::Matrix<double, 6, 6> root;
    for (double& value : root.reshaped()) value = random.around_zero();
    const Eigen::Matrix<double, 6, 6> mass =
        root * root.transpose() + Eigen::Matrix<double, 6, 6>::Identity();
    p.mass.insert(p.mass.end(), mass.data(), mass.data() + 36);
  }
  int constraint = -1;
  const auto add = [&](int a, int b, RowKind kind, int normal, double lower, double upper, double mu) {
    constraint += kind == RowKind::friction ? 0 : 1;
    p.row_body.insert(p.row_body.end(), {a, b});
    p.row_kind.push_back(kind);
    p.friction_row.push_back(normal);
    p.friction_coefficient.push_back(mu);
    p.lower.push_back(lower);
    p.upper.push_back(upper);
    p.row_constraint.push_back(constraint);
    p.contact_set.push_back(ContactSet::box);
    p.compliance.push_back(p.rhs.size() % 5 == 3 ? 0 : 1e-3 * (1 + random.uniform()));
    p.rhs.push_back(random.around_zero());
    for (int k = 0; k < 12; ++k) p.jacobian.push_back(b < 0 && k >= 6 ? 0 : random.around_zero());
  };
  for (int i = 0; i + 1 < bodies; ++i) add(i, i + 1, RowKind::bilateral, -1, -kInfinity, kInfinity, 0);
  for (int i = 0; i < bodies; ++i) {
    const int other = i % 2 == 0 && i + 2 < bodies ? i + 2 : -1, normal = static_cast<int>(p.rhs.size());
    add(i, other, RowKind::normal, -1, 0, kInfinity, 0);
    if (i % 4 == 3) continue;
    const bool carries = i % 4 != 1;
    for (int t = 0; t < tangents; ++t)
      add(i, other, RowKind::friction, normal, carries ? -kInfinity : 0, carries ? kInfinity : 0,
          carries ? 0.5 : 0);
    if (carries) p.contact_set[normal] = ContactSet::coulomb;
  }
  p.contact_point.assign(3 * p.rhs.size(), 0.0);
  p.warm_impulse.assign(p.rhs.size(), 0.0);
  EXPECT_EQ(find_problem_error(p), "");
  return p;
}

struct DeleteGlobal {
  void operator()(fclib_global* global) const {
    fclib_delete_global(global);  // what it points to, and not itself
    std::free(global);
  }
};
using GlobalOfLibrary = std::unique_ptr<fclib_global, DeleteGlobal>;

inline GlobalOfLibrary read_by_library(const std::filesystem::path& path) {
  return GlobalOfLibrary(fclib_read_global(path.c_str()));
}

// As fclib.h defines them: compressed columns and compressed rows.
inline Eigen::MatrixXd dense(const fclib_matrix& matrix) {
  Eigen::MatrixXd values = Eigen::MatrixXd::Zero(matrix.m, matrix.n);
  EXPECT_TRUE(matrix.nz == -1 || matrix.nz == -2);
  for (int line = 0; line < (matrix.nz == -1 ? matrix.n : matrix.m); ++line)
    for (int k = matrix.p[line]; k < matrix.p[line + 1]; ++k)
      (matrix.nz == -1 ? values(matrix.i[k], line) : values(line, matrix.i[k])) += matrix.x[k];
  return values;
}

inline Eigen::VectorXd dense(const double* values, Eigen::Index count) {
  return Eigen::Map<const Eigen::VectorXd>(values, count);
}

// The same in our arrays: 6n x 6n, m x 6n.
inline Eigen::MatrixXd dense_mass(const StepProblem& p) {
  Eigen::MatrixXd mass = Eigen::MatrixXd::Zero(6 * p.body_count(), 6 * p.body_count());
  for (std::size_t k = 0; k < p.mass.size(); ++k)
    mass(k / 36 * 6 + k % 36 / 6, k / 36 * 6 + k % 6) = p.mass[k];
  return mass;
}

inline Eigen::MatrixXd dense_jacobian(const StepProblem& p) {
  Eigen::MatrixXd jacobian = Eigen::MatrixXd::Zero(p.row_count(), 6 * p.body_count());
  for (int r = 0; r < p.row_count(); ++r)
    for (int k = 0; k < 12; ++k)
      if (const int body = p.row_body[2 * r + k / 6]; body >= 0)
        jacobian(r, 6 * body + k % 6) = p.jacobian[12 * r + k];
  return jacobian;
}

// J M^-1 J^T + C
inline Eigen::MatrixXd dense_w(const StepProblem& p) {
  const Eigen::MatrixXd jacobian = dense_jacobian(p);
  Eigen::MatrixXd w = jacobian * dense_mass(p).llt().solve(jacobian.transpose());
  for (int r = 0; r < p.row_count(); ++r) w(r, r) += p.compliance[r];
  return w;
}

// J v0 - b
inline Eigen::VectorXd dense_q(const StepProblem& p) {
  return dense_jacobian(p) * dense(p.free_velocity.data(), 6 * p.body_count()) -
         dense(p.rhs.data(), p.row_count());
}

}  // namespace cleave
