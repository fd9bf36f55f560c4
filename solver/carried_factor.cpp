#include "solver/carried_factor.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace cleave {
namespace {

// Iterations beside those that rows on other sides take: of a factor of this step, and of one before, since
// when the bodies have moved.
constexpr int kIterationsInStep = 2, kIterationsAnyway = 6;
// A system is solved so often, as its answer is refined.
constexpr int kSolves = 3;

bool is_zero(std::span<const double> values) {
  return std::ranges::all_of(values, [](double value) { return value == 0; });
}

}  // namespace

// Changes add up over the steps that a factor serves.
void CarriedFactor::begin_step(int changed_rows) {
  counts_ = {};
  is_own_ = is_of_step_ = false;
  const bool is_known = changed_rows < std::numeric_limits<int>::max() - expected_changes_;
  expected_changes_ = is_known ? expected_changes_ + changed_rows : std::numeric_limits<int>::max();
}

void CarriedFactor::bind(const PreparedStep& step, const Parts& parts) {
  step_ = &step;
  parts_ = parts;
  system_.bind(step);
}

void CarriedFactor::analyze(const PreparedStep& step, const Parts& parts, ParallelTasks& tasks) {
  bind(step, parts);
  has_factor_ = is_own_ = false;
  kernel_->analyze(step, parts, tasks);
  fits_ = true;
}

bool CarriedFactor::rebind(const PreparedStep& step, const Parts& parts, ParallelTasks& tasks) {
  bind(step, parts);
  fits_ = false;
  return has_factor_ || (fits_ = kernel_->rebind(step, parts, tasks));
}

bool CarriedFactor::factor_anew(ParallelTasks& tasks) {
  has_factor_ = is_own_ = is_of_step_ = false;  // also where the next lines find no memory
  if (!fits_ && !kernel_->rebind(*step_, parts_, tasks)) kernel_->analyze(*step_, parts_, tasks);
  fits_ = true;
  ++counts_.factorizations;
  has_factor_ = is_own_ = is_of_step_ = kernel_->factor({system_.rows().d(), blocks_}, tasks);
  counts_.mflop_done += kernel_->done_mflop();
  expected_changes_ = 0;
  factored_d_.assign(system_.rows().d().begin(), system_.rows().d().end());
  return has_factor_;
}

// J' p and J'^T are 24 flops a row each, M p 72 a body; five products and sums of vectors.
double CarriedFactor::iteration_mflop() const {
  const double rows = step_->row_count(), bodies = step_->body_count();
  return kFlopsOfAProduct * (kernel_->apply_mflop() + 1e-6 * (50 * rows + 132 * bodies));
}

// Assembly is half of a symmetric 12x12 matrix a row.
double CarriedFactor::anew_mflop() const {
  return kFlopsOfAProduct * 160e-6 * step_->row_count() + kernel_->local_mflop() + kernel_->interface_mflop();
}

bool CarriedFactor::pays_to_factor() const {
  double iterations = kIterationsAnyway + static_cast<double>(expected_changes_);
  if (is_of_step_) {
    iterations = kIterationsInStep;
    for (std::size_t r = 0; r < factored_d_.size(); ++r)
      iterations += factored_d_[r] != system_.rows().d()[r];
  }
  return kSolves * iterations * iteration_mflop() > anew_mflop();
}

bool CarriedFactor::factor(const RowWeights& weights, ParallelTasks& tasks, const RowWork& before) {
  run_work(before, *step_, tasks);
  blocks_.assign(weights.blocks.begin(), weights.blocks.end());
  system_.set({weights.d, blocks_});
  if (!has_factor_ || pays_to_factor()) return factor_anew(tasks);
  if (!blocks_.empty())
    tasks.run_over(step_->group_chunks(), [&](const Chunk& groups) { system_.turn(groups); });
  is_own_ = false;
  ++counts_.factor_reuses;
  return true;
}

void CarriedFactor::solve(std::span<const double> f_v, std::span<const double> f_r, std::span<double> dv,
                          std::span<double> dlambda, ParallelTasks& tasks, const RowsAround& around) {
  if (is_own_) return kernel_->solve(f_v, f_r, dv, dlambda, tasks, around);
  StageTimer timer(tasks.clock(), Stage::solve);
  const auto groups = step_->group_chunks();
  residual_.resize(f_v.size());
  tasks.run_over(groups, [&](const Chunk& chunk) {
    step_->do_rows(around.before, chunk);
    system_.weigh(chunk, f_r);
  });
  tasks.run_over(step_->body_chunks(), [&](const Chunk& chunk) { system_.collect(chunk, f_v, residual_); });
  const int most = kIterationsAnyway + static_cast<int>(anew_mflop() / iteration_mflop());
  if (!has_factor_ || !iterate(most, tasks)) {
    if (factor_anew(tasks)) return kernel_->solve(f_v, f_r, dv, dlambda, tasks, {{}, around.after});
    x_.assign(residual_.size(), 0.0);  // no factor, no increment: strategies see that nothing falls
  }
  tasks.run_over(groups, [&](const Chunk& chunk) {
    system_.expand(chunk, x_, f_r, dlambda);
    step_->do_rows(around.after, chunk);
  });
  std::ranges::copy(x_, dv.begin());
}

// action(c) of every component c of a vector over bodies.
template <class Action>
void CarriedFactor::over_components(ParallelTasks& tasks, const Action& action) {
  tasks.run_over(step_->body_chunks(), [&](const Chunk& bodies) {
    for (int c = 6 * bodies.first; c < 6 * bodies.last; ++c) action(c);
  });
}

// Summed chunk by chunk, so that threads do not change it.
double CarriedFactor::dot(std::span<const double> a, std::span<const double> b, ParallelTasks& tasks) {
  const auto bodies = step_->body_chunks();
  chunk_sums_.resize(bodies.size());
  tasks.run(static_cast<int>(bodies.size()), [&](int i) {
    const int first = 6 * bodies[i].first, last = 6 * bodies[i].last;
    chunk_sums_[i] = std::inner_product(a.begin() + first, a.begin() + last, b.begin() + first, 0.0);
  });
  return std::accumulate(chunk_sums_.begin(), chunk_sums_.end(), 0.0);
}

// Solves H x = residual_. False when the factor is no positive definite one, or when that takes more than so
// many iterations.
bool CarriedFactor::iterate(int most, ParallelTasks& tasks) {
  x_.assign(residual_.size(), 0.0);
  image_.resize(residual_.size());
  direction_.assign(residual_.size(), 0.0);
  double first = 0, last = 1;
  for (int k = 0;; ++k) {
    check_stop(tasks.stop());
    kernel_->apply_factor(residual_, image_, tasks);
    const double norm = dot(image_, residual_, tasks);
    if (k == 0) first = norm;
    const bool is_small = norm >= 0 && norm <= kCarriedAccuracy * kCarriedAccuracy * first;
    if (is_small && std::isfinite(first) && (k > 0 || is_zero(residual_))) return true;
    if (!(norm > 0 && std::isfinite(norm)) || k == most) return false;
    ++counts_.cg_iterations;
    const double turn = k == 0 ? 0 : norm / last;
    last = norm;
    over_components(tasks, [&](int c) { direction_[c] = image_[c] + turn * direction_[c]; });
    tasks.run_over(step_->group_chunks(),
                   [&](const Chunk& chunk) { system_.weigh_product(chunk, direction_); });
    tasks.run_over(step_->body_chunks(),
                   [&](const Chunk& chunk) { system_.collect_product(chunk, direction_, image_); });
    const double length = norm / dot(image_, direction_, tasks);
    over_components(tasks, [&](int c) {
      x_[c] += length * direction_[c];
      residual_[c] -= length * image_[c];
    });
  }
}

}  // namespace cleave
