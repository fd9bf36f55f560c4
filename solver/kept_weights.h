// What a kernel knows of its last factorisation: strategies that end near the solution change few weights
// from one to the next, and what depends on none of those stands as it is.
#pragma once

#include <span>
#include <utility>
#include <vector>

#include "solver/prepared_step.h"
#include "solver/row_weights.h"

namespace cleave {

class KeptWeights {
 public:
  // Of another analysis, after which nothing stands.
  void bind(const PreparedStep& step) {
    step_ = &step;
    changed_all_ = true;
    weights_.resize(step.row_count());
  }

  // Before a factorisation, which is taken for one that fails until end(). Whether nothing of the last one
  // stands: it failed, was of another preparation of the step, or one of the two has rows turned by blocks.
  // Their bases turn them too, so that equal weights do not say that nothing has changed.
  bool begin(const RowWeights& weights) {
    const long preparation = step_->preparations();
    const bool is_new = std::exchange(preparation_, preparation) != preparation;
    return std::exchange(changed_all_, true) || is_new || !weights.blocks.empty();
  }

  // Whether a weight of the group is another than in the last factorisation; d: (m), those that are taken
  // over. Of different groups it may be called side by side.
  bool take(const RowGroup& group, std::span<const double> d) {
    bool any = false;
    for (int r = group.first_row; r < group.first_row + group.row_count; ++r) {
      any |= weights_[r] != d[r];
      weights_[r] = d[r];
    }
    return any;
  }

  void end(bool succeeded, const RowWeights& weights) {
    changed_all_ = !succeeded || !weights.blocks.empty();
  }

 private:
  const PreparedStep* step_ = nullptr;
  bool changed_all_ = true;
  long preparation_ = 0;
  std::vector<double> weights_;  // (m)
};

}  // namespace cleave
