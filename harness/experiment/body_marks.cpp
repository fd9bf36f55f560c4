#include "harness/experiment/body_marks.h"

#include <cmath>

#include "harness/base/larger_or_nan.h"
#include "solver/residual.h"

namespace cleave {
namespace {

// The largest of the rows that touch each body; a NaN row makes its bodies NaN.
std::vector<float> largest_at_bodies(const StepProblem& problem, std::span<const double> of_row) {
  std::vector<double> largest(problem.body_count(), 0.0);
  for (int r = 0; r < problem.row_count(); ++r) {
    for (int side = 0; side < 2; ++side) {
      const int body = problem.row_body[2 * r + side];
      if (body < 0) continue;
      largest[body] = larger_or_nan(largest[body], std::abs(of_row[r]));
    }
  }
  std::vector<float> rounded;
  for (const double value : largest) rounded.push_back(round_to_11_bits(value));
  return rounded;
}

bool is_cut_off(const BodyGraph& graph, std::span<const int> part_of_body, int body) {
  for (const int other : graph.neighbours(body)) {
    if (part_of_body[other] != part_of_body[body]) return true;
  }
  return false;
}

}  // namespace

float round_to_11_bits(double value) {
  if (!std::isfinite(value)) return static_cast<float>(value);
  int exponent = 0;
  const double mantissa = std::frexp(value, &exponent);
  return static_cast<float>(std::ldexp(std::nearbyint(std::ldexp(mantissa, 11)), exponent - 11));
}

BodyMarks mark_bodies(const StepProblem& problem, const BodyGraph& graph, std::span<const int> part_of_body,
                      std::span<const double> impulse) {
  const int n = problem.body_count();
  BodyMarks marks;
  marks.part.assign(n, kNoPart);
  marks.interface.assign(n, 0);
  if (!part_of_body.empty()) {
    for (int i = 0; i < n; ++i) {
      marks.part[i] = static_cast<std::uint16_t>(part_of_body[i]);
      marks.interface[i] = is_cut_off(graph, part_of_body, i);
    }
  }
  marks.residual_m_per_s = largest_at_bodies(problem, row_residuals(problem, impulse));
  marks.largest_impulse_n_s = largest_at_bodies(problem, impulse);
  return marks;
}

}  // namespace cleave
