#include "solver/body_system.h"

#include <algorithm>

namespace cleave {

void BodySystem::bind(const PreparedStep& step, std::span<const int> position) {
  step_ = &step;
  position_ = position;
  group_sums_.resize(12 * step.groups().size());
}

inline BodyPair BodySystem::load(const RowGroup& group, std::span<const double> x) const {
  return load_pair(x.data() + place(group.body_a),
                   group.body_b < 0 ? nullptr : x.data() + place(group.body_b));
}

void BodySystem::weigh(const Chunk& groups, std::span<const double> f_r) {
  const std::span<const double> d = rows_.d();
  for (int g = groups.first; g < groups.last; ++g) {
    double sum[12];
    sum_rows(
        step_->groups()[g], rows_.jacobian(), [&](int r) { return d[r] * f_r[r]; }, sum);
    std::copy_n(sum, 12, group_sums_.data() + 12L * g);
  }
}

void BodySystem::weigh_product(const Chunk& groups, std::span<const double> x) {
  const std::span<const double> d = rows_.d();
  for (int g = groups.first; g < groups.last; ++g) {
    const BodyPair both = load(step_->groups()[g], x);
    double sum[12];
    sum_rows(
        step_->groups()[g], rows_.jacobian(),
        [&](int r) { return d[r] * row_times(rows_.jacobian() + 12L * r, both); }, sum);
    std::copy_n(sum, 12, group_sums_.data() + 12L * g);
  }
}

inline void BodySystem::collect_body(int body, std::span<const double> f_v, std::span<double> x) const {
  add_sides(step_->sides_of_body(body), group_sums_.data(), f_v.data() + 6L * body, x.data() + place(body));
}

void BodySystem::collect(const Chunk& bodies, std::span<const double> f_v, std::span<double> x) const {
  for (int body = bodies.first; body < bodies.last; ++body) collect_body(body, f_v, x);
}

void BodySystem::collect(std::span<const int> bodies, std::span<const double> f_v,
                         std::span<double> x) const {
  for (const int body : bodies) collect_body(body, f_v, x);
}

void BodySystem::collect_product(const Chunk& bodies, std::span<const double> x,
                                 std::span<double> out) const {
  for (int body = bodies.first; body < bodies.last; ++body) {
    const double* mass = step_->problem().mass.data() + 36L * body;
    const double* v = x.data() + place(body);
    double momentum[6] = {};
    for (int c = 0; c < 6; ++c) {
      for (int k = 0; k < 6; ++k) momentum[k] += mass[6 * c + k] * v[c];  // M is symmetric
    }
    add_sides(step_->sides_of_body(body), group_sums_.data(), momentum, out.data() + place(body));
  }
}

void BodySystem::expand(const Chunk& groups, std::span<const double> x, std::span<const double> f_r,
                        std::span<double> dlambda) const {
  const std::span<const double> d = rows_.d();
  for (int g = groups.first; g < groups.last; ++g) {
    const RowGroup& group = step_->groups()[g];
    const BodyPair both = load(group, x);
    visit_products(group, rows_.jacobian(), both, [&]<class Value>(int r, Value product) {
      write(read<Value>(&d[r]) * (read<Value>(&f_r[r]) - product), &dlambda[r]);
    });
  }
}

void BodySystem::to_bodies(std::span<const int> bodies, std::span<const double> x,
                           std::span<double> by_body) const {
  for (const int body : bodies) std::copy_n(x.data() + place(body), 6, by_body.data() + 6L * body);
}

void BodySystem::to_positions(std::span<const int> bodies, std::span<const double> by_body,
                              std::span<double> x) const {
  for (const int body : bodies) std::copy_n(by_body.data() + 6L * body, 6, x.data() + place(body));
}

}  // namespace cleave
