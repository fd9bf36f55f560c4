#include "solver/slab_sweeps.h"

#include <algorithm>
#include <cassert>
#include <limits>
#include <numeric>

#include "solver/counting_sort.h"
#include "solver/open_octets.h"

namespace cleave {
namespace {

// Longer groups of rows are sorted as if they were of this length.
constexpr int kLongestSorted = 255;

constexpr Octet empty_octet(int first_row, int row_count) {
  Octet octet{.first_row = first_row, .row_count = row_count, .body_a = {}, .body_b = {}};
  std::ranges::fill(octet.body_a, -1);
  std::ranges::fill(octet.body_b, -1);
  return octet;
}

signed char side_of(float impulse, float lower, float upper) {
  return static_cast<signed char>((impulse >= upper) - (impulse <= lower));
}

float to_float(double x) {
  constexpr double kMost = std::numeric_limits<float>::max();
  return static_cast<float>(std::clamp(x, -kMost, kMost));
}

}  // namespace

void SlabSweeps::bind(const PreparedStep& step, ParallelTasks& tasks) {
  assert(step.set().axes().empty());
  step_ = &step;
  slabs_.cut(step, kMostSweeps);
  sort_groups(step);
  tasks.run(slabs_.set_count(), [&](int set) { fill_octets(step, set); });
  assign_places(step);
  tasks.run(slabs_.set_count(), [&](int set) { pack_rows(step, set); });
}

void SlabSweeps::sort_groups(const PreparedStep& step) {
  const std::span<const RowGroup> all = step.groups();
  const int sets = slabs_.set_count(), groups = static_cast<int>(all.size());
  const int most = groups == 0 ? 0 : std::ranges::max(all, {}, &RowGroup::row_count).row_count;
  const int longest = std::min(most, kLongestSorted), lengths = longest + 1;
  const auto set_and_length = [&](int g) {
    return slabs_.set_of(all[g]) * lengths + longest - std::min(all[g].row_count, longest);
  };
  sort_into_buckets(groups, sets * lengths, set_and_length, bucket_first_, groups_);
  group_first_.resize(sets + 1);
  for (int set = 0; set <= sets; ++set) group_first_[set] = bucket_first_[set * lengths];
  octets_.resize(groups);
  place_of_group_.resize(groups);
  octet_count_.resize(sets);
  row_first_.resize(sets + 1);
  agreement_.resize(sets);
  changed_.resize(sets);
}

// The longest groups come first, each to the first octet that has room for it and neither of its bodies.
// Bodies are those of the step, and rows are counted from the first of the set, until places are assigned.
void SlabSweeps::fill_octets(const PreparedStep& step, int set) {
  const std::span<const RowGroup> all = step.groups();
  OpenOctets open;
  int octets = 0, rows = 0;
  for (const int g : groups_of_set(set)) {
    const auto [body_a, body_b, first_row, row_count] = all[g];
    int i = open.find(body_a, body_b);
    if (i < 0) {
      octets_[group_first_[set] + octets] = empty_octet(rows, row_count);
      rows += row_count;
      i = open.open(octets++);
    }
    Octet& octet = octets_[group_first_[set] + open.octet(i)];
    const int lane = open.add(i, body_a, body_b);
    octet.body_a[lane] = body_a;
    octet.body_b[lane] = body_b;
    place_of_group_[g] = kOctetLanes * octet.first_row + lane;
  }
  octet_count_[set] = octets;
  row_first_[set + 1] = rows;
}

// What two threads write stays apart in memory: velocities by slab and rows by set, in the order in which
// they are visited.
void SlabSweeps::assign_places(const PreparedStep& step) {
  const int n = step.body_count();
  sort_into_buckets(
      n, slabs_.count(), [this](int body) { return slabs_.of_body()[body]; }, slab_first_, bodies_by_slab_);
  place_of_body_.resize(n);
  for (int place = 0; place < n; ++place) place_of_body_[bodies_by_slab_[place]] = place;
  bodies_.resize(n + slabs_.set_count());
  std::fill(bodies_.begin() + n, bodies_.end(), SlabBody{});
  row_first_[0] = 0;
  std::partial_sum(row_first_.begin(), row_first_.end(), row_first_.begin());
  rows_.resize(row_first_.back());
  sides_.resize(row_first_.back());
}

void SlabSweeps::pack_rows(const PreparedStep& step, int set) {
  std::fill(rows_.begin() + row_first_[set], rows_.begin() + row_first_[set + 1], OctetRow{});
  std::fill(sides_.begin() + row_first_[set], sides_.begin() + row_first_[set + 1], RowSides{});
  for (Octet& octet : octets_of(set)) {
    octet.first_row += row_first_[set];
    for (int* body : {octet.body_a, octet.body_b}) {
      for (int lane = 0; lane < kOctetLanes; ++lane)
        body[lane] = body[lane] < 0 ? step.body_count() + set : place_of_body_[body[lane]];
    }
  }
  for (const int g : groups_of_set(set)) {
    place_of_group_[g] += kOctetLanes * row_first_[set];
    pack_group(step, g);
  }
}

void SlabSweeps::pack_group(const PreparedStep& step, int g) {
  const StepProblem& p = step.problem();
  const RowGroup& group = step.groups()[g];
  const int numbers = group.body_b < 0 ? 6 : 12, lane = place_of_group_[g] % kOctetLanes;
  for (int k = 0; k < group.row_count; ++k) {
    const int r = group.first_row + k;
    OctetRow& row = rows_[place_of_group_[g] / kOctetLanes + k];
    const double inverse = step.inverse_diagonal()[r];
    for (int c = 0; c < numbers; ++c) {
      row.jacobian[c][lane] = static_cast<float>(p.jacobian[12L * r + c] * inverse);
      row.mass_jacobian[c][lane] = static_cast<float>(step.mass_jacobian()[12L * r + c]);
    }
    row.kept[lane] = static_cast<float>(1 - p.compliance[r] * inverse);
    row.rest[lane] = static_cast<float>(p.rhs[r] * inverse);
    row.lower[lane] = to_float(p.lower[r]);
    row.upper[lane] = to_float(p.upper[r]);
  }
}

// for_body(body) of all bodies and for_group(g) of all groups.
template <class ForBody, class ForGroup>
void SlabSweeps::run_over_chunks(ParallelTasks& tasks, const ForBody& for_body,
                                 const ForGroup& for_group) const {
  const auto over = [](const auto& action) {
    return [&action](const Chunk& chunk) {
      for (int i = chunk.first; i < chunk.last; ++i) action(i);
    };
  };
  tasks.run_over(step_->body_chunks(), over(for_body), step_->group_chunks(), over(for_group));
}

void SlabSweeps::take_in(std::span<const double> impulse, std::span<const double> v, ParallelTasks& tasks) {
  const auto take_body = [&](int body) {
    SlabBody& own = bodies_[place_of_body_[body]];
    own = {};
    for (int c = 0; c < 6; ++c) own.velocity[c] = own.end[c] = static_cast<float>(v[6 * body + c]);
  };
  const auto take_group = [&](int g) {
    const RowGroup& group = step_->groups()[g];
    const int lane = place_of_group_[g] % kOctetLanes;
    for (int k = 0; k < group.row_count; ++k) {
      const int at = place_of_group_[g] / kOctetLanes + k;
      OctetRow& row = rows_[at];
      row.impulse[lane] = static_cast<float>(impulse[group.first_row + k]);
      row.change[lane] = 0;
      sides_[at][lane] = side_of(row.impulse[lane], row.lower[lane], row.upper[lane]);
    }
  };
  run_over_chunks(tasks, take_body, take_group);
  momentum_ = SweepMomentum(step_->least_relative_compliance());
}

// What is at a bound there is at the bound here, to the last digit.
void SlabSweeps::give_out(std::span<double> impulse, std::span<double> v, ParallelTasks& tasks) const {
  const auto give_body = [&](int body) {
    const SlabBody& own = bodies_[place_of_body_[body]];
    for (int c = 0; c < 6; ++c) v[6 * body + c] = own.velocity[c];
  };
  const StepProblem& p = step_->problem();
  const auto give_group = [&](int g) {
    const RowGroup& group = step_->groups()[g];
    const int lane = place_of_group_[g] % kOctetLanes;
    for (int k = 0; k < group.row_count; ++k) {
      const OctetRow& row = rows_[place_of_group_[g] / kOctetLanes + k];
      const float found = row.impulse[lane];
      const int r = group.first_row + k;
      impulse[r] = found <= row.lower[lane]   ? p.lower[r]
                   : found >= row.upper[lane] ? p.upper[r]
                                              : std::clamp<double>(found, p.lower[r], p.upper[r]);
    }
  };
  run_over_chunks(tasks, give_body, give_group);
}

// How many rows of the set changed sides.
int SlabSweeps::update_sides(int set) {
  int changed = 0;
  for (int r = row_first_[set]; r < row_first_[set + 1]; ++r) {
    const OctetRow& row = rows_[r];
    for (int lane = 0; lane < kOctetLanes; ++lane) {
      const signed char side = side_of(row.impulse[lane], row.lower[lane], row.upper[lane]);
      changed += side != sides_[r][lane];
      sides_[r][lane] = side;
    }
  }
  return changed;
}

// Bodies of a slab are pushed by its inside, which comes before the gaps that share them.
void SlabSweeps::visit(int set) {
  const float share = momentum_.share();
  if (set < slabs_.count())
    for (int body = slab_first_[set]; body < slab_first_[set + 1]; ++body) push_body(share, bodies_[body]);
  float agreement[kOctetLanes] = {};
  for (const Octet& octet : octets_of(set))
    visit_octet(octet, share, rows_.data(), bodies_.data(), agreement);
  agreement_[set] = std::accumulate(agreement, agreement + kOctetLanes, 0.0);
}

void SlabSweeps::end_sweep(bool looks, int settled_rows) {
  momentum_.end_sweep(std::accumulate(agreement_.begin(), agreement_.end(), 0.0));
  if (!looks) return;
  changed_rows_ = std::accumulate(changed_.begin(), changed_.end(), 0);
  is_settled_ = changed_rows_ <= settled_rows;
}

int SlabSweeps::run(int sweeps, int settled_rows, ParallelTasks& tasks) {
  assert(sweeps > 0 && sweeps <= kMostSweeps);
  const int sets = slabs_.set_count(), tasks_of_sweep = slabs_.tasks_of_sweep();
  is_settled_ = false;
  tasks.run(Stage::predict, slabs_.graph(), [&](int task) {
    const int sweep = task / tasks_of_sweep, set = task % tasks_of_sweep;
    if (sweep >= sweeps || is_settled_) return;
    const bool looks = (sweep + 1) % kSweepsOfALook == 0 || sweep == sweeps - 1;
    if (set == sets) return end_sweep(looks, settled_rows);
    check_stop(tasks.stop());
    visit(set);
    if (looks) changed_[set] = update_sides(set);
  });
  return changed_rows_;
}

// Rows of an octet stay together, so its place tells it.
int SlabSweeps::octet_of_group(int group) const {
  const int set = slabs_.set_of(step_->groups()[group]), row = place_of_group_[group] / kOctetLanes;
  const auto first = octets_.begin() + group_first_[set], last = first + octet_count_[set];
  return static_cast<int>(std::ranges::upper_bound(first, last, row, {}, &Octet::first_row) - first) - 1;
}

}  // namespace cleave
