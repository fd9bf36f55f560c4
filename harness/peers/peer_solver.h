// A peer as an ordinary solver: it gets a child process of its own, for as long as it may take, and what
// comes back is judged.
//
// - More than peer-max-rows rows, or contacts that obey another law than the peer knows: refused, before
//   anything is formed.
// - Longer than peer-timeout-s of wall time, forming its input included: the child is killed, timeout.
// - Ended by a signal: crashed, with the signal's name. Without memory: out_of_memory.
// - ok where the judge (residual.h) finds the impulses within the limit, whatever the library says of itself;
//   else not_converged, or diverged where they are no numbers.
//
// t_s is the library's call alone. What it is given, mostly a dense matrix, is formed outside of that time,
// as it is not the library's doing, and so is what forking costs. Libraries run on one thread.
#pragma once

#include "harness/peers/peer.h"
#include "solver/step_solver.h"

namespace cleave {

class PeerSolver : public StepSolver {
 public:
  // name: of the registry row; must outlive the object. law: what contacts of problems must obey.
  PeerSolver(const char* name, PeerFunction solve, ContactSet law, const SolveOptions& options,
             const Settings& settings)
      : name_(name), solve_(solve), law_(law), stop_(options.stop), settings_(settings) {}
  bool uses_partition() const override { return false; }

 private:
  std::string refuse_set(const StepProblem& problem) override;
  SolveSummary do_solve(const StepProblem& problem, const Parts& parts, Solution& solution) override;
  std::string find_refusal(const StepProblem& problem) const;

  const char* name_;
  PeerFunction solve_;
  ContactSet law_;
  const std::atomic<bool>* stop_;
  Settings settings_;
};

}  // namespace cleave
