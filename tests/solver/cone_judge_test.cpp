// The judge on contacts that have a cone or Coulomb's law: against a projection by search, against the block
// on a plane, and with errors planted.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "solver/residual.h"
#include "tests/solver/cone_contacts.h"
#include "tests/solver/problem_makers.h"
#include "tests/solver/seeded_random.h"

namespace cleave {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// The nearest point of { (n, t): |t| <= mu n }: with n chosen, t is shortened where it is too long, and what
// is left to choose is one number, whose distance is convex.
std::array<double, 3> search_projection(const std::array<double, 3>& x, double mu) {
  const auto point = [&](double n) {
    const double length = std::hypot(x[1], x[2]);
    const double share = length > mu * n ? mu * n / length : 1;
    return std::array<double, 3>{n, share * x[1], share * x[2]};
  };
  const auto distance = [&](double n) {
    const auto p = point(n);
    return std::hypot(x[0] - p[0], x[1] - p[1], x[2] - p[2]);
  };
  double low = 0, high = 2 * (std::abs(x[0]) + std::hypot(x[1], x[2])) + 1;
  for (int i = 0; i < 300; ++i) {
    const double third = (high - low) / 3;
    (distance(low + third) <= distance(high - third) ? high : low) +=
        distance(low + third) <= distance(high - third) ? -third : third;
  }
  return point((low + high) / 2);
}

TEST(ConeJudgeTest, AgreesWithAProjectionBySearch) {
  SeededRandom random(1);
  int inside = 0, apart = 0, surface = 0;
  for (int trial = 0; trial < 3000; ++trial) {
    Block block;
    for (int k = 0; k < 3; ++k) {
      block.free_velocity[k] = random.uniform(-1, 1);
      block.rhs[k] = random.uniform(-1, 1);
      block.compliance[k] = random.uniform(0, 2);
    }
    block.mu = std::exp(random.uniform(-3, 3));
    block.tangents = 1 + trial % 2;
    block.set = trial % 4 < 2 ? ContactSet::cone : ContactSet::coulomb;
    const StepProblem problem = make_block(block);
    ASSERT_EQ(find_problem_error(problem), "");
    std::vector<double> impulse(problem.row_count());
    for (double& entry : impulse) entry = random.uniform(-1, 2);

    std::array<double, 3> w{}, x{};
    double d = 0;
    for (int k = 0; k <= block.tangents; ++k) {
      w[k] = block.free_velocity[k] + (1 + block.compliance[k]) * impulse[k] - block.rhs[k];
      d = std::max(d, 1 + block.compliance[k]);
    }
    if (block.set == ContactSet::coulomb) w[0] += block.mu * std::hypot(w[1], w[2]);
    for (int k = 0; k <= block.tangents; ++k) x[k] = impulse[k] - w[k] / d;
    const std::array<double, 3> nearest = search_projection(x, block.mu);
    const std::vector<double> residuals = row_residuals(problem, impulse);
    for (int k = 0; k <= block.tangents; ++k)
      EXPECT_NEAR(residuals[k], d * std::abs(impulse[k] - nearest[k]), 1e-6)
          << "trial " << trial << " row " << k;
    const double length = std::hypot(x[1], x[2]);
    ++(length <= block.mu * x[0] ? inside : block.mu * length <= -x[0] ? apart : surface);
  }
  EXPECT_GT(inside, 200);
  EXPECT_GT(apart, 200);
  EXPECT_GT(surface, 200);
}

TEST(ConeJudgeTest, AcceptsAnswersOnPaperAtEveryAngle) {
  for (const ContactSet set : {ContactSet::cone, ContactSet::coulomb}) {
    for (const double degrees : {0, 15, 30, 45, 200}) {
      // Coulomb's threshold is mu times the push; a cone's is the same, as long as it sticks.
      for (const double speed : {0.0, 0.1, 0.2499999, 0.2500001, 0.3, 5.0}) {
        const Paper paper = make_paper(set, degrees * std::numbers::pi / 180, speed);
        const ResidualReport report = judge(paper.problem, paper.impulse);
        EXPECT_LE(report.residual_m_per_s, 1e-15) << degrees << " degrees, " << speed << " m/s";
        EXPECT_TRUE(report.exact);
        EXPECT_LE(report.energy_excess_j, 1e-16);
        const double leaving = report.velocity[2] + kCompliance * paper.impulse[0];
        const bool slides = speed > 0.25;
        const double lifted = set == ContactSet::cone && slides ? (speed - 0.25) * 0.5 / (1 + 0.25) : 0;
        EXPECT_NEAR(leaving, lifted, 1e-12) << "mu |w_t| under a cone, nothing under Coulomb's law";
      }
    }
  }
}

TEST(ConeJudgeTest, AcceptsOneTangentHugeCoefficientsAndContactsApart) {
  for (const ContactSet set : {ContactSet::cone, ContactSet::coulomb}) {
    for (const double speed : {0.1, 0.3, -5.0}) {
      const Paper one = make_paper(set, 0, std::abs(speed), 0.5, 1);
      EXPECT_LE(judge(one.problem, one.impulse).residual_m_per_s, 1e-15);
    }
    const Paper huge = make_paper(set, 1, 100, 1e9);
    const double amplified = set == ContactSet::coulomb ? 1e9 : 1;  // mu |w_t|, where w_t is rounding
    EXPECT_LE(judge(huge.problem, huge.impulse).residual_m_per_s, 1e-13 * amplified);
    const StepProblem leaving = make_block({{0.5, 0.1, 0.1}, {}, {}, 0.5, set, 2});
    EXPECT_EQ(judge(leaving, std::vector<double>{0, 0, 0}).residual_m_per_s, 0);
  }
}

// Leaving slowly and sliding fast is apart under Coulomb's law; a cone takes it for a contact.
TEST(ConeJudgeTest, KnowsTheLiftOffOfAConeFromCoulombsLaw) {
  const std::vector<double> none{0, 0, 0};
  Block leaving{{0.1, 3, 4}, {}, {}, 0.5, ContactSet::coulomb, 2};
  EXPECT_EQ(judge(make_block(leaving), none).residual_m_per_s, 0);
  leaving.set = ContactSet::cone;
  EXPECT_GT(judge(make_block(leaving), none).residual_m_per_s, 0.5);
  for (const auto& [right, wrong] :
       {std::pair(ContactSet::cone, ContactSet::coulomb), std::pair(ContactSet::coulomb, ContactSet::cone)}) {
    Paper paper = make_paper(right, 0.5, 2);
    paper.problem.contact_set[0] = wrong;
    EXPECT_GT(judge(paper.problem, paper.impulse).residual_m_per_s, 0.1);
  }
}

TEST(ConeJudgeTest, NoticesEveryImpulseThatIsOff) {
  for (const ContactSet set : {ContactSet::cone, ContactSet::coulomb}) {
    for (const double speed : {0.1, 0.3, 5.0}) {
      const Paper paper = make_paper(set, 0.7, speed);
      for (int k = 0; k < 3; ++k) {
        for (const double off : {1e-6, -1e-6}) {
          std::vector<double> wrong = paper.impulse;
          wrong[k] += off;
          const ResidualReport report = judge(paper.problem, wrong);
          EXPECT_FALSE(report.exact) << "row " << k << ", " << speed << " m/s";
          EXPECT_LE(report.residual_m_per_s, 1e-5);
        }
      }
      std::vector<double> turned = paper.impulse;  // of the right length along another direction
      std::swap(turned[1], turned[2]);
      EXPECT_GT(judge(paper.problem, turned).residual_m_per_s, 1e-2);
    }
  }
}

// One d a contact: the largest of its rows.
TEST(ConeJudgeTest, MeasuresAContactByTheLargestDiagonalOfItsRows) {
  const StepProblem problem = make_block({{}, {}, {0.5, 0, 3}, 0.5, ContactSet::cone, 2});
  // lambda - w / d is outside the polar cone's reach: apart, so that d |lambda| is what is left.
  StepProblem leaving = problem;
  leaving.free_velocity[2] = 100;
  const std::vector<double> residuals = row_residuals(leaving, std::vector<double>{1, 0.5, 0});
  EXPECT_DOUBLE_EQ(residuals[0], 4);
  EXPECT_DOUBLE_EQ(residuals[1], 2);
  EXPECT_DOUBLE_EQ(residuals[2], 0);
}

StepProblem with_cones(StepProblem problem, int every, ContactSet set) {
  problem.contact_set.assign(problem.row_count(), ContactSet::box);
  for (int r = 0; r < problem.row_count(); r += 3 * every) {
    problem.contact_set[r] = set;
    for (int k = 1; k < 3; ++k) problem.lower[r + k] = -(problem.upper[r + k] = kInfinity);
  }
  return problem;
}

TEST(ConeJudgeTest, RowsOfBoxesBesideConesAreMeasuredAsBefore) {
  for (const ContactSet set : {ContactSet::cone, ContactSet::coulomb}) {
    const StepProblem boxes = make_pile(1, {}), mixed = with_cones(boxes, 2, set);
    ASSERT_EQ(find_problem_error(mixed), "");
    SeededRandom random(3);
    std::vector<double> impulse(boxes.row_count());
    for (double& entry : impulse) entry = random.uniform(-0.1, 0.2);
    const std::vector<double> of_boxes = row_residuals(boxes, impulse),
                              of_mixed = row_residuals(mixed, impulse);
    double normal = 0, friction = 0;
    for (int r = 0; r < boxes.row_count(); ++r) {
      if (r / 3 % 2 == 1) {
        EXPECT_EQ(of_mixed[r], of_boxes[r]) << r;
      }
      double& of_kind = boxes.row_kind[r] == RowKind::normal ? normal : friction;
      of_kind = std::max(of_kind, of_mixed[r]);
    }
    const ResidualReport report = judge(mixed, impulse);
    EXPECT_EQ(report.residual_normal_m_per_s, normal);
    EXPECT_EQ(report.residual_friction_m_per_s, friction);
    EXPECT_EQ(report.residual_m_per_s, std::max(normal, friction));
    EXPECT_EQ(report.residual_bilateral_m_per_s, 0);
  }
}

TEST(ConeJudgeTest, ImpulsesThatAreNoNumbersGiveNone) {
  const Paper paper = make_paper(ContactSet::cone, 0, 1);
  for (const double bad : {kInfinity, std::nan("")}) {
    const ResidualReport report = judge(paper.problem, std::vector<double>{1, bad, 0});
    EXPECT_TRUE(std::isnan(report.residual_m_per_s));
    EXPECT_FALSE(report.exact);
  }
}

}  // namespace
}  // namespace cleave
