// Stops and motors of hinges and sliders against dWorldStep, to 1e-9: at either stop, driven freely and
// saturated, both at once, with all that can be set on the axis; single steps and a motion through all of it.
#include <gtest/gtest.h>

#include <array>
#include <cstdio>
#include <map>
#include <string>

#include "harness/world/extract.h"
#include "tests/harness/dense_oracle.h"
#include "tests/harness/joined_bodies.h"

namespace cleave {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// The functions of a kind of joint with an axis.
struct AxisKind {
  const JointCase* joint;
  dReal (*position)(dJointID joint);
  void (*set)(dJointID joint, int parameter, dReal value);
};
const AxisKind kAxisKinds[] = {{&kJointCases[1], dJointGetHingeAngle, dJointSetHingeParam},
                               {&kJointCases[2], dJointGetSliderPosition, dJointSetSliderParam}};

// Where the joint is between its stops.
enum class Stop { none, far, low, high, both_in_one };
constexpr Stop kStops[] = {Stop::none, Stop::far, Stop::low, Stop::high, Stop::both_in_one};

// Of a hinge whose first body is the static environment ODE tells the angle with one sign and stops it with
// the other (0.16.2).
double position_as_stopped(const AxisKind& kind, dJointID joint, Attachment attachment) {
  const bool is_reversed = attachment == Attachment::static_then_body && kind.position == dJointGetHingeAngle;
  return is_reversed ? -kind.position(joint) : kind.position(joint);
}

void set_stops(const AxisKind& kind, dJointID joint, Attachment attachment, Stop stop) {
  if (stop == Stop::none) return;
  const double position = position_as_stopped(kind, joint, attachment);
  constexpr double kBeyond = 0.03;
  double low = position - 0.4, high = position + 0.4;
  if (stop == Stop::low || stop == Stop::both_in_one) low = position + kBeyond;
  if (stop == Stop::high) high = position - kBeyond;
  if (stop == Stop::both_in_one) high = low;
  kind.set(joint, dParamLoStop, low);
  kind.set(joint, dParamHiStop, high);
}

struct Motor {
  double force;  // N or N m; 0: none
  double speed;
};
constexpr Motor kMotors[] = {{0, 0}, {0.5, 2}, {0.5, -2}, {1e5, 1}, {1e5, -1}, {5, 0}};

bool is_at_stop(Stop stop) { return stop != Stop::none && stop != Stop::far; }

// What the sixth row must look like, by ODE's manual.
void expect_sixth_row(const StepProblem& problem, Stop stop, const Motor& motor) {
  const bool is_driven = motor.force > 0;
  ASSERT_EQ(problem.row_count(), is_at_stop(stop) || is_driven ? 6 : 5);
  if (problem.row_count() == 5) return;
  EXPECT_EQ(find_problem_error(problem), "");
  EXPECT_EQ(problem.row_kind[5], RowKind::bilateral);
  std::array<double, 2> bounds = {-motor.force * kStep_s, motor.force * kStep_s};
  if (stop == Stop::low) bounds = {0, kInfinity};
  if (stop == Stop::high) bounds = {-kInfinity, 0};
  if (stop == Stop::both_in_one) bounds = {-kInfinity, kInfinity};
  EXPECT_EQ(problem.lower[5], bounds[0]);
  EXPECT_EQ(problem.upper[5], bounds[1]);
  if (!is_at_stop(stop)) {
    EXPECT_EQ(problem.rhs[5], motor.speed);
  }
}

using Change = std::function<void(const AxisKind&, dJointID)>;

struct Own {
  const char* name;
  Change set;
};
const Own kOwn[] = {
    {"nothing", [](const AxisKind&, dJointID) {}},
    {"softness",
     [](const AxisKind& kind, dJointID joint) {
       kind.set(joint, dParamStopERP, 0.7);
       kind.set(joint, dParamStopCFM, 3e-3);
       kind.set(joint, dParamCFM, 2e-3);
     }},
    {"bounce", [](const AxisKind& kind, dJointID joint) { kind.set(joint, dParamBounce, 0.6); }},
    {"fudge factor", [](const AxisKind& kind, dJointID joint) { kind.set(joint, dParamFudgeFactor, 0.3); }},
};

// The exact solution of the step and dWorldStep's, in two worlds of which only ODE's has the step's softness.
void compare(const AxisKind& kind, Attachment attachment, std::uint64_t seed, Stop stop, const Motor& motor,
             const Own& own, std::array<int, 3>& seen, double& largest) {
  const Softness step{0.35, 1e-5};
  const auto make = [&](Softness softness) {
    auto world = make_joined_bodies(*kind.joint, attachment, seed, true, softness);
    const dJointID joint = world->content().joints[0];
    set_stops(kind, joint, attachment, stop);
    kind.set(joint, dParamFMax, motor.force);
    kind.set(joint, dParamVel, motor.speed);
    own.set(kind, joint);
    return world;
  };
  const auto ours = make({0.2, 1e-10});
  const std::uint64_t before = ours->state_hash();
  const StepProblem problem = extract_joints(*ours, step);
  expect_sixth_row(problem, stop, motor);
  // Reading the rows changes nothing: neither the world nor the forces that a motor at its stop gives.
  EXPECT_EQ(ours->state_hash(), before);
  EXPECT_EQ(extract_joints(*ours, step).free_velocity, problem.free_velocity);
  const OracleSolution exact = solve_exactly(problem);
  ASSERT_LE(exact.residual, 1e-10);
  if (problem.row_count() == 6) {
    const bool lower = exact.impulse[5] == problem.lower[5], upper = exact.impulse[5] == problem.upper[5];
    ++seen[lower ? 0 : upper ? 2 : 1];
  }
  const auto ode = make(step);
  dWorldStep(ode->world(), kStep_s);
  const double difference = velocity_difference(*ode, exact.velocity);
  EXPECT_LE(difference, 1e-9);
  largest = std::max(largest, difference);
}

TEST(JointLimits, OneStepAgreesWithDWorldStepWhateverIsSetOnTheAxis) {
  for (const AxisKind& kind : kAxisKinds) {
    double largest = 0;
    std::array<int, 3> seen{};
    for (const Stop stop : kStops)
      for (const Motor& motor : kMotors)
        for (const Own& own : kOwn)
          for (const Attachment attachment : kAttachments)
            for (std::uint64_t seed = 1; seed <= 6; ++seed) {
              SCOPED_TRACE(std::string(kind.joint->name) + ", stop " +
                           std::to_string(static_cast<int>(stop)) + ", motor " + std::to_string(motor.force) +
                           " at " + std::to_string(motor.speed) + ", own " + own.name + ", attachment " +
                           std::to_string(static_cast<int>(attachment)) + ", seed " + std::to_string(seed));
              compare(kind, attachment, seed, stop, motor, own, seen, largest);
            }
    std::printf("%s: largest velocity difference %.2e; sixth row at its low bound %d, between %d, high %d\n",
                kind.joint->name, largest, seen[0], seen[1], seen[2]);
    for (const int count : seen) EXPECT_GT(count, 100);
  }
}

// Warm impulses of a row that goes and comes: none of another row, and none beyond its bounds.
TEST(JointLimits, WarmImpulsesStayWithinTheBoundsOfTheStep) {
  const auto world = make_joined_bodies(kJointCases[1], Attachment::two_bodies, 3, true, {});
  const dJointID joint = world->content().joints[0];
  set_stops(kAxisKinds[0], joint, Attachment::two_bodies, Stop::low);
  ContactMemory memory;
  const StepProblem at_low = extract_joints(*world, {});
  ASSERT_EQ(at_low.row_count(), 6);
  memory.remember({}, at_low, std::vector<double>{1, 2, 3, 4, 5, 6});
  EXPECT_EQ(extract(*world, {}, {}, memory).warm_impulse, (std::vector<double>{1, 2, 3, 4, 5, 6}));
  set_stops(kAxisKinds[0], joint, Attachment::two_bodies, Stop::high);
  EXPECT_EQ(extract(*world, {}, {}, memory).warm_impulse, (std::vector<double>{1, 2, 3, 4, 5, 0}));
  set_stops(kAxisKinds[0], joint, Attachment::two_bodies, Stop::far);
  const StepProblem free = extract(*world, {}, {}, memory);
  EXPECT_EQ(free.warm_impulse, (std::vector<double>{1, 2, 3, 4, 5}));
  memory.remember({}, free, free.warm_impulse);
  set_stops(kAxisKinds[0], joint, Attachment::two_bodies, Stop::low);
  EXPECT_EQ(extract(*world, {}, {}, memory).warm_impulse, (std::vector<double>{1, 2, 3, 4, 5, 0}));
}

// An arm on a hinge and a load on a slider of it, driven to and fro between stops, too weakly at times: in
// every step ODE has the velocities of the exact solution.
TEST(JointLimits, AMotionThroughStopsAgreesInEveryStep) {
  const auto world = make_test_world(
      [](dWorldID w, dSpaceID, SceneContent& content) {
        dWorldSetERP(w, 0.2);
        dWorldSetCFM(w, 1e-5);
        TestRandom random(7);
        const dBodyID arm = add_random_body(w, content, random), load = add_random_body(w, content, random);
        const dJointID hinge = dJointCreateHinge(w, nullptr), slider = dJointCreateSlider(w, nullptr);
        dJointAttach(hinge, arm, nullptr);
        dJointSetHingeAnchor(hinge, 0.3, 0.2, 0.1);
        dJointSetHingeAxis(hinge, 1, 2, 0.5);
        dJointSetHingeParam(hinge, dParamLoStop, -0.5);
        dJointSetHingeParam(hinge, dParamHiStop, 0.7);
        dJointAttach(slider, load, arm);
        dJointSetSliderAxis(slider, 0.2, 0.3, 1);
        dJointSetSliderParam(slider, dParamLoStop, -0.2);
        dJointSetSliderParam(slider, dParamHiStop, 0.3);
        content.joints = {hinge, slider};
      },
      9.81, true);
  const dJointID hinge = world->content().joints[0], slider = world->content().joints[1];
  std::map<std::string, int> seen;
  double largest = 0;
  for (int step = 0; step < 400; ++step) {
    const double way = step / 50 % 2 == 0 ? 1 : -1;
    const double force = step / 100 % 2 == 0 ? 1000 : 20;
    dJointSetHingeParam(hinge, dParamFMax, step < 300 ? force : 0);
    dJointSetHingeParam(hinge, dParamVel, 2 * way);
    dJointSetSliderParam(slider, dParamFMax, step < 200 ? force : 0);
    dJointSetSliderParam(slider, dParamVel, way);
    const StepProblem problem = extract_joints(*world, {});
    const OracleSolution exact = solve_exactly(problem);
    ASSERT_LE(exact.residual, 1e-10) << step;
    for (int r = 0; r < problem.row_count(); ++r) {
      if (problem.lower[r] == -kInfinity && problem.upper[r] == kInfinity) continue;
      const bool is_motor = problem.lower[r] > -kInfinity && problem.upper[r] < kInfinity;
      const bool at_bound = exact.impulse[r] == problem.lower[r] || exact.impulse[r] == problem.upper[r];
      ++seen[is_motor ? (at_bound ? "weak motor" : "motor")
                      : (problem.lower[r] == 0 ? "low stop" : "high stop") +
                            std::string(at_bound ? ", free" : "")];
    }
    dWorldStep(world->world(), kStep_s);
    const double difference = velocity_difference(*world, exact.velocity);
    EXPECT_LE(difference, 1e-9) << "step " << step;
    largest = std::max(largest, difference);
  }
  std::printf("largest velocity difference %.2e\n", largest);
  for (const char* state :
       {"motor", "weak motor", "low stop", "high stop", "low stop, free", "high stop, free"})
    EXPECT_GT(seen[state], 0) << state;
}

}  // namespace
}  // namespace cleave
