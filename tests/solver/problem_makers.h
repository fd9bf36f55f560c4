// Step problems made for the tests, from a seed, without a physics engine: small random ones that the
// enumeration oracle can solve, and larger ones with the structure of piles, towers and chains. All pass
// find_problem_error.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "solver/step_problem.h"
#include "tests/solver/seeded_random.h"

namespace cleave {

inline constexpr double kTestStep_s = 1.0 / 60;
inline constexpr double kTestErp = 0.2;

using Vec3 = std::array<double, 3>;

struct RowSpec {
  int body_a = 0;
  int body_b = -1;
  std::array<double, 6> jacobian_a{};
  std::array<double, 6> jacobian_b{};
  double rhs = 0;
  double compliance = 0;
  double lower = -std::numeric_limits<double>::infinity();
  double upper = std::numeric_limits<double>::infinity();
  RowKind kind = RowKind::bilateral;
  int friction_row = -1;
  double friction_coefficient = 0;
  int constraint = 0;
  Vec3 point{};
};

// Appends one row; returns its index.
int append_row(StepProblem& problem, const RowSpec& row);
// Appends one body with the mass block diag(mass, mass, mass, inertia); returns its index.
int append_body(StepProblem& problem, double mass_kg, const Vec3& inertia_kg_m2,
                const std::array<double, 6>& velocity);

struct SmallProblemOptions {
  int most_bodies = 4;
  int most_rows = 10;
  double least_cfm = 1e-6;  // one cfm per problem, drawn on a log scale
  double most_cfm = 1e-3;
  double mass_ratio = 1e6;          // bodies weigh 1 kg .. mass_ratio kg
  bool zero_inside_bounds = false;  // every row has lo <= 0 <= hi
  bool feasible = false;  // some velocity satisfies all rows at once: no huge impulses at low compliance
};

// n = 1..most_bodies, m = 1..most_rows: bilateral, one-sided, boxed and fixed (lo = hi) rows, friction boxes
// (some with bound 0), copies of rows, integer Jacobians, zero right-hand sides, whole problems at rest
// (every impulse 0).
StepProblem make_small_problem(std::uint64_t seed, const SmallProblemOptions& options = {});

struct PileOptions {
  int columns = 3;  // blocks along x, y and z; layers are shifted by a third of a block like bricks
  int rows = 3;
  int layers = 3;
  double cfm = 1e-5;
  double mu = 0.5;        // 0: no friction rows
  double mass_ratio = 1;  // blocks weigh 1 kg or mass_ratio kg at random
};

// Unit blocks in a grid: 4 contacts per touching pair of faces (and with the ground), rows normal, t1, t2.
StepProblem make_pile(std::uint64_t seed, const PileOptions& options);

struct ChainOptions {
  int links = 20;
  int extra_joints = 0;  // further ball joints between random links: closed loops
  bool hinges = false;   // hinges about z in one plane (redundant when closed) in place of ball joints
  bool closed = false;   // joint between the last link and the first
  bool doubled = false;  // every tenth joint is there twice
  double cfm = 1e-5;
  double bob_mass_kg = 1;  // mass of the last link; the others weigh 1 kg
};

// Links on a circle, the first one held by the world.
StepProblem make_chain(std::uint64_t seed, const ChainOptions& options);

// Parts of the bodies, ids 0..parts-1, none empty (parts <= bodies).
std::vector<int> single_part(int bodies);
std::vector<int> own_parts(int bodies);
std::vector<int> sliced_parts(int bodies, int parts);  // ranges of indices
std::vector<int> random_parts(SeededRandom& random, int bodies, int parts);

// Number of rows whose two bodies lie in different parts.
int count_cut_rows(const StepProblem& problem, const std::vector<int>& part_of_body);

}  // namespace cleave
