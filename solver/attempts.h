// What a direct solve tries until an answer is exact.
//
// The strategies that were asked for, or that `auto` picks (strategies/automatic.h), one after the other, on
// the problem itself; then, where compliance is so small, or zero, that rounding kept those above the limit,
// the same by proximal steps (proximal_step.h) of less and less delta. Each hand-over is counted. When all
// fail, the impulses of the least residual stay.
#pragma once

#include <limits>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "harness/base/parameter.h"
#include "solver/prepared_step.h"
#include "solver/proximal_step.h"
#include "solver/solve_state.h"
#include "solver/strategies/strategy.h"

namespace cleave {

class Attempts {
 public:
  // strategy: a name of registry.h. settings: values of the parameters that strategies declare. own, where
  // given, runs in place of the registry's strategy of that name.
  Attempts(std::string_view strategy, const Settings& settings, std::unique_ptr<Strategy> own);

  // The impulse sets that the first strategy takes; of `auto`, that of the strategy which takes most.
  SetKind takes();

  // step: prepared with the problem. It is so again when false is returned; after proximal steps that solved
  // the problem it is left prepared with their copy of it, of the same bodies and rows. warm_impulse: along
  // the axes of the set. True where the impulses of the state are within the limit.
  bool run(PreparedStep& step, Kernel& kernel, std::span<const double> warm_impulse, SolveState& state,
           SolveSummary& summary);

 private:
  struct Link {
    std::string_view name;
    std::unique_ptr<Strategy> strategy;
  };
  // The impulses of the least residual among those offered.
  struct Best {
    double residual = std::numeric_limits<double>::infinity();
    std::vector<double> impulse;
    void clear() { residual = std::numeric_limits<double>::infinity(); }
    void offer(SolveState& state);
    void restore(SolveState& state) const;
  };

  Strategy& strategy(std::string_view name);
  bool run_chain(SolveState& state, std::span<const double> warm_impulse);
  bool run_proximal(SolveState& state);
  bool attempt(PreparedStep& step, Kernel& kernel, double delta, std::span<const double> warm_impulse,
               SolveState& state, SolveSummary& summary);

  std::string strategy_;
  Settings settings_;
  std::vector<Link> links_;  // strategies made so far
  ProximalStep proximal_;
  Best chain_best_, proximal_best_, attempt_best_;
};

}  // namespace cleave
