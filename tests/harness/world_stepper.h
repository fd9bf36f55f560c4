// Steps a world built by a test as a run does, every step solved by `exact`, judged and moved on. Keeps the
// last step's problem and impulses, so that a test can read forces.
#pragma once

#include <gtest/gtest.h>

#include <array>
#include <memory>
#include <utility>
#include <vector>

#include "harness/experiment/friction.h"
#include "harness/experiment/friction_converged.h"
#include "harness/world/extract.h"
#include "harness/world/ode_world.h"
#include "solver/registry.h"
#include "solver/residual.h"

namespace cleave {

class WorldStepper {
 public:
  WorldStepper(std::unique_ptr<OdeWorld> world, const ExtractOptions& options)
      : world_(std::move(world)),
        options_(options),
        part_of_body_(world_->body_count(), 0),
        solver_(make_step_solver("exact", {})) {}

  void step() {
    world_->before_step(steps_done_++);
    const std::vector<ContactPoint> contacts = world_->collide(8, nullptr);
    problem_ = extract(*world_, contacts, options_, memory_);
    solution_.impulse = problem_.warm_impulse;
    if (const auto set = friction_model(options_.friction).set) set(options_, problem_);
    if (options_.friction == FrictionModel::box_converged) {
      unconverged_bounds_ +=
          !converge_friction_bounds(problem_, *solver_, part_of_body_, solution_).converged;
    } else {
      solver_->solve(problem_, part_of_body_, solution_);
    }
    const ResidualReport report = judge(problem_, solution_.impulse);
    inexact_steps_ += !report.exact;
    world_->advance(report.velocity, options_.h_s);
    memory_.remember(contacts, problem_, solution_.impulse);
  }

  void steps(int count) {
    for (int k = 0; k < count; ++k) step();
  }

  // Force on a body from one constraint in the last step, N: the linear part of J^T lambda / h.
  std::array<double, 3> force_n(int constraint, int body) const {
    std::array<double, 3> force{};
    for (int r = 0; r < problem_.row_count(); ++r)
      for (int side = 0; side < 2; ++side) {
        if (problem_.row_constraint[r] != constraint || problem_.row_body[2 * r + side] != body) continue;
        for (int k = 0; k < 3; ++k)
          force[k] += problem_.jacobian[12 * r + 6 * side + k] * solution_.impulse[r] / options_.h_s;
      }
    return force;
  }

  // Ids of the constraints between two bodies (-1 = static) in the last step, ascending.
  std::vector<int> constraints_between(int a, int b) const {
    std::vector<int> found;
    for (int r = 0; r < problem_.row_count(); ++r) {
      const std::pair<int, int> bodies{problem_.row_body[2 * r], problem_.row_body[2 * r + 1]};
      if (bodies != std::pair{a, b} && bodies != std::pair{b, a}) continue;
      if (found.empty() || found.back() != problem_.row_constraint[r])
        found.push_back(problem_.row_constraint[r]);
    }
    return found;
  }

  BodyState state(int body) const { return world_->state(body); }
  const StepProblem& problem() const { return problem_; }
  const std::vector<double>& impulse() const { return solution_.impulse; }
  int inexact_steps() const { return inexact_steps_; }
  int unconverged_bounds() const { return unconverged_bounds_; }

 private:
  std::unique_ptr<OdeWorld> world_;
  ExtractOptions options_;
  std::vector<int> part_of_body_;
  std::unique_ptr<StepSolver> solver_;
  ContactMemory memory_;
  StepProblem problem_;
  Solution solution_;
  int steps_done_ = 0;
  int inexact_steps_ = 0;
  int unconverged_bounds_ = 0;
};

}  // namespace cleave
