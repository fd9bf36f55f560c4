#include "solver/strategies/coulomb_shift.h"

#include <Eigen/Cholesky>
#include <algorithm>

namespace cleave {
namespace {

using Eigen::Map, Eigen::MatrixXd, Eigen::VectorXd;

Map<VectorXd> as_vector(std::vector<double>& x) { return {x.data(), static_cast<Eigen::Index>(x.size())}; }

// x: of so many columns at least.
Map<MatrixXd> as_columns(std::vector<double>& x, std::size_t rows, int columns) {
  return {x.data(), static_cast<Eigen::Index>(rows), columns};
}

}  // namespace

void CoulombShift::begin(std::size_t cones) {
  for (std::vector<double>* x : {&change_, &apart_, &last_change_, &last_apart_}) x->assign(cones, 0.0);
  for (std::vector<double>* x : {&changes_, &aparts_}) x->resize(cones * kMemory);
  restart();
}

// In the place of the oldest, once there are kMemory of them.
void CoulombShift::add_difference() {
  const int column = (used_ - 1) % kMemory, columns = std::min(used_, kMemory);
  const Map<MatrixXd> aparts = as_columns(aparts_, apart_.size(), columns);
  as_columns(changes_, change_.size(), columns).col(column) = as_vector(change_) - as_vector(last_change_);
  as_columns(aparts_, apart_.size(), columns).col(column) = as_vector(apart_) - as_vector(last_apart_);
  gram_.col(column).head(columns).noalias() = aparts.transpose() * aparts.col(column);
  gram_.row(column).head(columns) = gram_.col(column).head(columns);
}

// To the combination of the changes seen whose distance would be least, were the map linear.
void CoulombShift::extrapolate(int columns) {
  using Small = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, kMemory, kMemory>;
  using SmallVector = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, kMemory, 1>;
  const Map<MatrixXd> aparts = as_columns(aparts_, apart_.size(), columns);
  Small gram = gram_.topLeftCorner(columns, columns);
  gram.diagonal() *= 1 + 1e-12;  // dependent differences
  const SmallVector shares = gram.ldlt().solve(SmallVector(aparts.transpose() * as_vector(apart_)));
  if (!shares.allFinite()) return;
  as_vector(change_).noalias() -= as_columns(changes_, change_.size(), columns) * shares;
  as_vector(change_).noalias() -= aparts * shares;
}

double CoulombShift::improve(std::span<const double> wanted) {
  as_vector(apart_) = Map<const VectorXd>(wanted.data(), as_vector(change_).size()) - as_vector(change_);
  if (used_ > 0) add_difference();
  const int columns = std::min(used_++, kMemory);
  last_change_ = change_;
  last_apart_ = apart_;
  as_vector(change_) += as_vector(apart_);
  if (columns > 0) extrapolate(columns);
  return as_vector(apart_).lpNorm<Eigen::Infinity>();
}

void CoulombShift::subtract_change(std::span<const FrictionCone> cones, std::span<double> f_r) const {
  for (std::size_t k = 0; k < change().size(); ++k) f_r[cones[k].first_row] -= change_[k];
}

}  // namespace cleave
