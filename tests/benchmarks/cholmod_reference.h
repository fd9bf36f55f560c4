// The step matrix H = M + J^T diag(D) J as CHOLMOD sees it: the yardstick of the solver's own factorisation.
#pragma once

#include <cholmod.h>

#include <span>
#include <vector>

#include "solver/step_problem.h"

namespace cleave {

class CholmodReference {
 public:
  // Assembles H for D (m) and analyses it with the best of CHOLMOD's orderings. supernodal: dense panels,
  // else one column at a time. Throws std::runtime_error when CHOLMOD fails.
  CholmodReference(const StepProblem& problem, std::span<const double> d, bool supernodal);
  ~CholmodReference();
  CholmodReference(const CholmodReference&) = delete;
  CholmodReference& operator=(const CholmodReference&) = delete;

  void factor();                                           // numeric factorisation, nothing else
  double flops() const { return flops_; }                  // `fl` of the analysis: no padding of supernodes
  std::vector<double> solve(std::span<const double> f_v);  // (n, 6) H^-1 f_v

 private:
  cholmod_common common_;
  cholmod_sparse* matrix_ = nullptr;
  cholmod_factor* factor_ = nullptr;
  double flops_ = 0;
};

}  // namespace cleave
