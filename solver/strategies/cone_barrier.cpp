#include "solver/strategies/cone_barrier.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace cleave {
namespace {

using Eigen::Vector3d;

Vector3d at(const LaneVector& x, int lane) { return {x.n[lane], x.u[lane], x.v[lane]}; }

LaneVector to_second_order(const Lanes& mu, const LaneVector& impulse) {
  return {mu * impulse.n, impulse.u, impulse.v};
}

LaneVector inside(LaneVector x, const Lanes& margin) {
  x.n = x.n.max(tangential(x) + margin);
  return x;
}

template <int Rows>
void store_basis(const LaneWeights& weights, int lane, double* basis) {
  for (int column = 0; column < Rows; ++column) {
    const Vector3d entries = at(weights.basis.row[column], lane);
    for (int i = 0; i < Rows; ++i) basis[Rows * column + i] = entries[i];
  }
}

}  // namespace

// task(contacts, k, chunk) for all contacts, four at a time, in the chunks of their rows.
template <class Task>
void ConeBarrier::run_over_contacts(SolveState& state, const Task& task) const {
  if (contacts_.empty()) return;
  state.run_over_rows([&](int, int, int chunk) {
    for (int k = contacts_first_[chunk]; k < contacts_first_[chunk + 1]; ++k) task(contacts_[k], k, chunk);
  });
}

void ConeBarrier::list_contacts(const SolveState& state) {
  const ImpulseSet& set = state.step->set();
  contacts_.clear();
  contacts_first_.clear();
  for (const Chunk& chunk : state.step->group_chunks()) {
    contacts_first_.push_back(static_cast<int>(contacts_.size()));
    const auto [first, last] = state.step->rows_of(chunk);
    auto cones = set.cones_of(first, last);
    for (; !cones.empty(); cones = cones.subspan(contacts_.back().count)) contacts_.emplace_back(cones);
  }
  contacts_first_.push_back(static_cast<int>(contacts_.size()));
  count_ = set.cones().size();
}

void ConeBarrier::start(SolveState& state, std::span<const double> speed) {
  list_contacts(state);
  point_.resize(contacts_.size());
  scaled_gap_.resize(contacts_.size());
  compliance_.resize(contacts_.size());
  now_.resize(contacts_.size());
  kept_.resize(contacts_.size());
  is_kept_ = false;
  run_over_contacts(state, [&](const ContactLanes& four, int k, int) {
    const Lanes least = four.load_normal(speed), d = four.load_normal(state.step->diagonal());
    Point& point = point_[k];
    point.s = inside(to_second_order(four.mu, four.load(state.impulse)), least / d);
    LaneVector z = four.load(state.slack);
    z.n /= four.mu;
    point.z = inside(z, least);
    const LaneScaling scaling = find_scaling(point.s, point.z);
    point.w = scaling.v;
    point.w_inverse = scaling.v_inverse;
    point.by = divisor(point.w * point.z);
  });
}

void ConeBarrier::weigh(SolveState& state, std::span<double> inverse_weight) {
  const std::span<WeightBlock> blocks = state.cone_blocks();
  const FrictionCone* first = state.step->set().cones().data();
  run_over_contacts(state, [&](const ContactLanes& four, int k, int) {
    const Point& point = point_[k];
    const LaneVector gap = to_second_order(four.mu, four.load(state.impulse)) - point.s;
    scaled_gap_[k] = transposed_times(point.w_inverse, four.is_there * gap);
    compliance_[k] = four.load(inverse_weight);
    LaneMatrix x = point.w_inverse;
    x.row[0] = four.mu * x.row[0];
    x.row[2] = four.second_tangent * x.row[2];
    const LaneWeights weights = find_weight_basis(x, compliance_[k]);
    four.store(weights.inverse, inverse_weight);
    for (int lane = 0; lane < four.count; ++lane) {
      WeightBlock& block = blocks[four.cone + lane - first];
      const auto store = block.row_count == 3 ? store_basis<3> : store_basis<2>;
      store(weights, lane, block.basis.data());
    }
  });
}

void ConeBarrier::aim(SolveState& state, double product, bool second_order) {
  run_over_contacts(state, [&](const ContactLanes& four, int k, int) {
    const LaneVector& l = point_[k].by.l;
    Direction& now = now_[k];
    now.c = LaneVector{.n = Lanes::Constant(product)} - jordan_product(l, l);
    if (second_order) now.c = now.c - jordan_product(now.ds, now.dz);
    now.c = four.is_there * now.c;
    now.q = jordan_divide(now.c, point_[k].by);
  });
}

void ConeBarrier::add_to_right_hand_side(SolveState& state) const {
  run_over_contacts(state, [&](const ContactLanes& four, int k, int) {
    const LaneVector scaled = point_[k].by.l + now_[k].q - scaled_gap_[k];
    const LaneVector of_rows = to_second_order(four.mu, point_[k].w_inverse * scaled);
    four.store(four.load(state.f_r) + of_rows, state.f_r);
  });
}

BarrierCourse ConeBarrier::follow(SolveState& state) {
  courses_.assign(state.chunk_count(), ChunkCourse{});
  run_over_contacts(state, [&](const ContactLanes& four, int k, int chunk) {
    const Point& point = point_[k];
    Direction& now = now_[k];
    now.ds = transposed_times(point.w_inverse, to_second_order(four.mu, four.load(state.dlambda))) +
             scaled_gap_[k];
    now.dz = now.q - now.ds;
    ChunkCourse& course = courses_[chunk];
    const Lanes fastest = inverse_step(point.by, now.ds).max(inverse_step(point.by, now.dz));
    course.inverse_step = std::max(course.inverse_step, fastest.maxCoeff());
    course.product[0] += (four.is_there * dot(point.by.l, point.by.l)).sum();
    course.product[1] += dot(point.by.l, now.q).sum();
    course.product[2] += dot(now.ds, now.dz).sum();
  });
  return join_courses(courses_);
}

// There w = S (z + dz), as the direction solves the equation in w.
void ConeBarrier::predict_shift(SolveState& state, std::span<double> shift) const {
  const FrictionCone* first = state.step->set().cones().data();
  run_over_contacts(state, [&](const ContactLanes& four, int k, int) {
    const Lanes speed = four.mu * tangential(point_[k].w_inverse * (point_[k].by.l + now_[k].dz));
    for (int lane = 0; lane < four.count; ++lane)
      shift[four.cone + lane - first] = four.cone[lane].coulomb ? speed[lane] : 0.0;
  });
}

void ConeBarrier::correct(SolveState& state, double trial, double low, double high) {
  before_.resize(now_.size());
  now_.swap(before_);
  run_over_contacts(state, [&](const ContactLanes& four, int k, int) {
    const LaneVector& l = point_[k].by.l;
    const Direction& before = before_[k];
    Direction& now = now_[k];
    const Lanes step = Lanes::Constant(trial);
    const LaneVector product = jordan_product(l + step * before.ds, l + step * before.dz);
    now.c = before.c + four.is_there * change_into_band(product, low, high);
    now.q = jordan_divide(now.c, point_[k].by);
  });
}

void ConeBarrier::advance(SolveState& state, double step) {
  const bool leaves = std::exchange(is_kept_, false);
  if (leaves) point_.swap(kept_);
  const std::vector<Point>& from = leaves ? kept_ : point_;
  run_over_contacts(state, [&](const ContactLanes&, int k, int) {
    const Point& old = from[k];
    Point& point = point_[k];
    const Lanes share = Lanes::Constant(step);
    const LaneVector s = old.by.l + share * now_[k].ds, z = old.by.l + share * now_[k].dz;
    const LaneScaling scaling = find_scaling(s, z);
    point.s = transposed_times(old.w, s);
    point.z = old.w_inverse * z;
    point.by = divisor(scaling.v * z);
    point.w = scaling.v * old.w;
    point.w_inverse = old.w_inverse * scaling.v_inverse;
  });
}

void ConeBarrier::restore() {
  if (!std::exchange(is_kept_, true)) point_.swap(kept_);
}

double ConeBarrier::rounding(SolveState& state, std::span<const double> row_velocity) {
  if (contacts_.empty()) return 0;
  worst_.assign(state.chunk_count(), 0.0);
  run_over_contacts(state, [&](const ContactLanes& four, int k, int chunk) {
    const LaneVector dlambda = four.load(state.dlambda), &c = compliance_[k];
    const LaneMatrix& inverse = point_[k].w_inverse;
    const LaneVector scaled = transposed_times(inverse, to_second_order(four.mu, dlambda));
    const LaneVector of_compliance = {c.n * dlambda.n, c.u * dlambda.u, c.v * dlambda.v};
    const LaneVector weighed = to_second_order(four.mu, inverse * scaled) + of_compliance;
    const LaneVector left = four.load(state.f_r) - four.load(row_velocity) - weighed;
    for (const Lanes& entries : {left.n, left.u, left.v})
      worst_[chunk] = larger_or_infinite(worst_[chunk], entries.abs().maxCoeff<Eigen::PropagateNaN>());
  });
  return std::ranges::max(worst_);
}

}  // namespace cleave
