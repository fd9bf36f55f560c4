// A step solver finds the impulses of a StepProblem. A solver is a named pair strategy:kernel: the strategy
// finds the active set (which rows sit at a bound), the kernel solves one linear system. See
// solver/README.md.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "harness/base/stop.h"
#include "solver/parts.h"
#include "solver/solution.h"
#include "solver/stage_times.h"
#include "solver/step_problem.h"

namespace cleave {

enum class SolveStatus { ok, not_converged, timeout, out_of_memory, diverged, refused, crashed, skipped };
const char* to_string(SolveStatus status);
std::optional<SolveStatus> find_status(std::string_view name);  // by what to_string says
std::vector<std::string> status_names();

// Whether a solve with this status left impulses that can be judged, and numbers about itself. One that was
// out of time was ended from outside and left none.
bool has_result(SolveStatus status);
bool has_result(std::string_view status);  // by what to_string says; false for a name that is none

// Of every solver. What one of them alone has are parameters of its registry row.
struct SolveOptions {
  int threads = 1;                // >= 1
  double target_m_per_s = 1e-11;  // residual aimed at; exact is judged at kExactLimit
  // Solves are those of consecutive steps of one simulation, each from the solution before: what pays is
  // carried from one to the next (carried_factor.h), and results depend on the steps before, within the
  // target.
  bool session = false;
  // Where there is one and it comes true, a solve ends with Stopped at its next factorisation,
  // back-substitution, sweep or block column of a dense interface. Must outlive the solver.
  const std::atomic<bool>* stop = nullptr;
  // Whether a solve on one thread, once its time is taken, is modelled on more workers
  // (StageTimes::model_ms), and what the dispatch of a task is charged then. A session is not.
  bool models_workers = false;
  DispatchCost dispatch = {};
  // Of the factor and its workspace: what was predicted to need more is out_of_memory before any of it is
  // allocated.
  std::uint64_t memory_limit_bytes = std::numeric_limits<std::uint64_t>::max();
};

struct SolveSummary {
  SolveStatus status = SolveStatus::ok;
  std::string message;   // why, when not ok
  std::string strategy;  // what ran at the end
  std::string kernel;
  std::string auto_reason = "-";  // why auto chose it
  int iterations = 0;             // active-set or interior-point iterations, sweeps for pgs
  int factorizations = 0;         // numeric factorisations of the whole system
  int factor_reuses = 0;          // systems solved with the factor of another, in a session
  int cg_iterations = 0;          // of conjugate gradients with such a factor
  int fallbacks = 0;              // hand-overs from one strategy to the next
  int refinements = 0;            // iterative refinement steps at the end
  int engine_messages = 0;        // given by a foreign engine while it solved
  int interface_unknowns = 0;     // size of the interface system (rows, or 6 x bodies for schur-bodies)
  double factor_mflop_local = 0;  // per factorisation, without padding, subsystem interiors
  double factor_mflop_interface = 0;
  double factor_mflop_done = 0;  // of all factorisations together, less what was kept of the one before
  // Of the factor and its workspace, 1e6 bytes, before it was allocated; NaN where nothing is factored.
  double factor_predicted_mb = std::numeric_limits<double>::quiet_NaN();
  StageTimes times;  // ms by named stage, total, and the modelled makespans
};

class StepSolver {
 public:
  virtual ~StepSolver() = default;

  // parts: the subsystems, one part id per body and, where they are split recursively, the tree (parts.h);
  // ignored where !uses_partition(), and the tree by kernels that know one level. Parts that are none are
  // `refused`, with a message that names what is wrong.
  // solution.impulse is the warm start (m); impulse and velocity are the result. The object keeps its
  // scratch: the second solve of one structure allocates nothing in our code. Numerical trouble is a status,
  // never an exception; Stopped and std::bad_alloc are, and leave nothing in solution to rely on.
  SolveSummary solve(const StepProblem& problem, const Parts& parts, Solution& solution);

  // Whether the result's cost depends on the parts; solvers that ignore partitions run once a step.
  virtual bool uses_partition() const = 0;

 private:
  // Why this solver does not take the problem's impulse set (find_set_refusal, with the name of who refuses);
  // empty: it does. Asked only where some set is no interval of a row.
  virtual std::string refuse_set(const StepProblem& problem);
  virtual SolveSummary do_solve(const StepProblem& problem, const Parts& parts, Solution& solution) = 0;

  PartsCheck parts_check_;
};

}  // namespace cleave
