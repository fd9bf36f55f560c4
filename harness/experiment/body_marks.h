// What a solution looks like from the bodies: the numbers by which a picture of a step is coloured.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "partition/body_graph.h"
#include "solver/step_problem.h"

namespace cleave {

struct BodyMarks {
  std::vector<std::uint16_t> part;      // (n) kNoPart where the solver ignores parts
  std::vector<std::uint8_t> interface;  // (n) 1: an edge of the graph leads to another part
  std::vector<float>
      residual_m_per_s;  // (n) largest residual of the rows that touch the body; 0 without rows
  std::vector<float> largest_impulse_n_s;  // (n) largest |impulse| of these rows
};

inline constexpr std::uint16_t kNoPart = 65535;

// part_of_body: (n), or empty where the solver ignores parts. impulse: (m).
BodyMarks mark_bodies(const StepProblem& problem, const BodyGraph& graph, std::span<const int> part_of_body,
                      std::span<const double> impulse);

// The nearest float with 11 significant bits; NaN, infinities and zero stay.
float round_to_11_bits(double value);

}  // namespace cleave
