// Coulomb's law in the Newton direction of a cone: the change of its shift.
//
// Under the law a cone's normal slack is raised by s = mu |w_t| (de Saxce and Feng 1998), which moves with
// the velocities. The exact derivative is not symmetric and no kernel factors it; but for a given change ds
// the direction is that of a cone, one back-substitution, and it leads to tangential velocities w_t + dw_t.
// What is wanted is the fixed point
//
//     ds = mu |w_t + dw_t(ds)| - s,
//
// found with Anderson's acceleration over the last few ds, which is GMRES where the map is linear. Sources:
// Anderson, "Iterative procedures for nonlinear integral equations", J. ACM 12, 1965; Walker and Ni, SIAM J.
// Numer. Anal. 49, 2011.
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "solver/friction_cone.h"

namespace cleave {

class CoulombShift {
 public:
  // Of so many cones; the change is zero, and so is what it is taken from.
  void begin(std::size_t cones);
  // Forgets earlier changes of another direction; the present one is where the next begins.
  void restart() { used_ = 0; }

  // (cones) ds, m/s.
  std::span<const double> change() const { return change_; }

  // f_r of the cones' normal rows -= ds.
  void subtract_change(std::span<const FrictionCone> cones, std::span<double> f_r) const;

  // wanted (cones): the change that the direction of change() leads to. Makes the next change; returns how
  // far the two were apart, m/s, at most.
  double improve(std::span<const double> wanted);

 private:
  static constexpr int kMemory = 8;

  void add_difference();
  void extrapolate(int columns);

  // (cones); these keep their memory where Eigen's would not, as the number of cones changes.
  std::vector<double> change_, apart_, last_change_, last_apart_;
  std::vector<double> changes_, aparts_;  // (cones, kMemory) differences of consecutive ones, by columns
  Eigen::Matrix<double, kMemory, kMemory> gram_;  // aparts_^T aparts_
  int used_ = 0;
};

}  // namespace cleave
