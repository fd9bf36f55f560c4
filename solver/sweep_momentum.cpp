#include "solver/sweep_momentum.h"

#include <algorithm>
#include <cmath>

namespace cleave {
namespace {

// A sweep is no gradient step (its iteration matrix is not symmetric), and more momentum brings it astray:
// from a cold start twelve steps of a pile of 200 boxes and one each of piles of 200, 600 and 800 (cfm 1e-5)
// take 42 factorisations after 60 sweeps with 0.8, 51 with 0.85, 65 with 0.9; 67 without any, after 80
// sweeps.
constexpr double kMostShare = 0.8;

}  // namespace

SweepMomentum::SweepMomentum(double least_relative_compliance) {
  const double root = std::sqrt(std::min(1.0, least_relative_compliance));
  most_share_ = std::min((1 - root) / (1 + root), kMostShare);
}

void SweepMomentum::end_sweep(double agreement) {
  if (!(agreement >= 0)) {
    t_ = 1;
    share_ = 0;
    return;
  }
  const double before = t_;
  t_ = (1 + std::sqrt(1 + 4 * before * before)) / 2;
  share_ = static_cast<float>(std::min((before - 1) / t_, most_share_));
}

}  // namespace cleave
