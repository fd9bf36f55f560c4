// What lets Gauss-Seidel sweeps converge in fewer of them: a sweep begins where the change of the last one
// points to,
//
//     y_k = lambda_k + beta_k d_k,     lambda_k+1 = sweep(y_k),     d_k+1 = lambda_k+1 - lambda_k,
//     beta_k = min((t_k - 1) / t_k+1, (1 - sqrt c) / (1 + sqrt c), 0.8)
//     t_k+1 = (1 + sqrt(1 + 4 t_k^2)) / 2,    t_1 = 1,
//
// and so for v, which is linear in lambda; c is the least C_r / d_r, a bound from below of what the problem
// is convex by. Where a sweep goes back, (lambda_k+1 - y_k) . d_k+1 < 0, momentum begins anew. Sources:
// Nesterov, "Introductory Lectures on Convex Optimization", 2004, section 2.2; O'Donoghue and Candes,
// "Adaptive restart for accelerated gradient schemes", Found. Comput. Math. 15, 2015.
#pragma once

namespace cleave {

class SweepMomentum {
 public:
  // c: least C_r / d_r.
  explicit SweepMomentum(double least_relative_compliance = 1);

  // beta of the next sweep.
  float share() const { return share_; }
  // agreement: of the sweep, the product above.
  void end_sweep(double agreement);

 private:
  double most_share_, t_ = 1;
  float share_ = 0;
};

}  // namespace cleave
