#include "solver/strategies/coulomb_shift.h"

#include <Eigen/Cholesky>
#include <algorithm>

namespace cleave {

void CoulombShift::begin(std::size_t cones) {
  const auto count = static_cast<Eigen::Index>(cones);
  for (Eigen::VectorXd* v : {&change_, &apart_, &last_change_, &last_apart_}) v->setZero(count);
  for (Eigen::MatrixXd* m : {&changes_, &aparts_}) m->resize(count, kMemory);
  restart();
}

// The combination of the changes seen whose distance would be least, were the map linear.
double CoulombShift::improve(std::span<const double> wanted) {
  apart_ = Eigen::Map<const Eigen::VectorXd>(wanted.data(), change_.size()) - change_;
  const double worst = apart_.lpNorm<Eigen::Infinity>();
  const int columns = std::min(used_, kMemory);
  if (used_ > 0) {
    const int column = (used_ - 1) % kMemory;
    changes_.col(column) = change_ - last_change_;
    aparts_.col(column) = apart_ - last_apart_;
    gram_.col(column).head(columns).noalias() = aparts_.leftCols(columns).transpose() * aparts_.col(column);
    gram_.row(column).head(columns) = gram_.col(column).head(columns);
  }
  ++used_;
  last_change_ = change_;
  last_apart_ = apart_;
  change_ += apart_;
  if (columns == 0) return worst;
  using Small = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, kMemory, kMemory>;
  using SmallVector = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, kMemory, 1>;
  const auto differences = aparts_.leftCols(columns);
  Small gram = gram_.topLeftCorner(columns, columns);
  gram.diagonal() *= 1 + 1e-12;  // dependent differences
  const SmallVector shares = gram.ldlt().solve(SmallVector(differences.transpose() * apart_));
  if (shares.allFinite()) change_ -= (changes_.leftCols(columns) + differences) * shares;
  return worst;
}

void CoulombShift::subtract_change(std::span<const FrictionCone> cones, std::span<double> f_r) const {
  for (std::size_t k = 0; k < change().size(); ++k) f_r[cones[k].first_row] -= change_[k];
}

}  // namespace cleave
