// The list of the interior point's constants has every member of the struct, and a solver made with a changed
// one uses it.
#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <string>
#include <type_traits>

#include "solver/direct_solver.h"
#include "solver/registry.h"
#include "tests/solver/interior_constants_list.h"
#include "tests/solver/problem_makers.h"
#include "tests/solver/solver_checks.h"

namespace cleave {
namespace {

struct AnyValue {
  template <class Member>
  operator Member() const;
};

// How many values an aggregate can be initialised with.
template <class Aggregate, class... Values>
constexpr int member_count() {
  if constexpr (requires { Aggregate{Values{}..., AnyValue{}}; }) {
    return member_count<Aggregate, Values..., AnyValue>();
  } else {
    return sizeof...(Values);
  }
}

TEST(InteriorConstants, TheListHasEveryMemberOnce) {
  InteriorConstants constants;
  std::set<std::string> names;
  std::set<const void*> members;
  visit_constants(constants, [&](const char* name, auto& member, const Alternatives&) {
    names.insert(name);
    members.insert(&member);
  });
  EXPECT_EQ(static_cast<int>(names.size()), member_count<InteriorConstants>());
  EXPECT_EQ(static_cast<int>(members.size()), member_count<InteriorConstants>());
}

TEST(InteriorConstants, EveryAlternativeIsAnotherValueOfTheMembersType) {
  const InteriorConstants constants;
  visit_constants(constants, [&](const char* name, auto& member, const Alternatives& tried) {
    EXPECT_FALSE(tried.others.empty()) << name;
    std::set<double> values(tried.others.begin(), tried.others.end());
    if (!std::isnan(tried.off)) values.insert(tried.off);
    EXPECT_EQ(values.size(), tried.others.size() + !std::isnan(tried.off)) << name << " twice";
    for (double value : values) {
      EXPECT_NE(value, static_cast<double>(member)) << name << " is its default";
      if (std::is_same_v<std::decay_t<decltype(member)>, int>) {
        EXPECT_EQ(value, std::trunc(value)) << name;
      }
    }
  });
}

SolveSummary solve(const StepProblem& problem, StepSolver& solver, Solution& solution) {
  solution = cold_start(problem);
  return solver.solve(problem, single_part(problem.body_count()), solution);
}

TEST(InteriorConstants, ASolverUsesThoseItWasMadeWithAndNoOther) {
  const StepProblem pile = make_pile(1, {.layers = 5, .cfm = 1e-10, .mass_ratio = 1e3});
  Solution before, changed, after;
  const auto named = make_step_solver("interior-point:monolithic", {});
  const SolveSummary first = solve(pile, *named, before);
  InteriorConstants without;
  without.corrections = 0;
  const auto own =
      make_direct_solver("interior-point", "monolithic", {}, Settings(), make_interior_point(without));
  const SolveSummary other = solve(pile, *own, changed);
  EXPECT_TRUE(is_exact(pile, other, changed));
  EXPECT_NE(other.factorizations, first.factorizations);
  EXPECT_EQ(solve(pile, *named, after).factorizations, first.factorizations);
  EXPECT_EQ(after.impulse, before.impulse);
}

TEST(InteriorConstants, TheDefaultsAreThoseOfTheNamedStrategy) {
  const StepProblem pile = make_pile(2, {.layers = 4, .cfm = 1e-8});
  Solution named, own;
  const SolveSummary first = solve(pile, *make_step_solver("interior-point:monolithic", {}), named);
  const SolveSummary second = solve(pile,
                                    *make_direct_solver("interior-point", "monolithic", {}, Settings(),
                                                        make_interior_point(InteriorConstants{})),
                                    own);
  EXPECT_EQ(second.factorizations, first.factorizations);
  EXPECT_EQ(own.impulse, named.impulse);
}

// With constants that take the first error that grows for the end, an iteration that does not begin anew
// solves 49 of these.
TEST(InteriorConstants, AnIterationThatEndsWithoutAnAnswerBeginsAnew) {
  InteriorConstants hasty;
  hasty.settled = 1e300;
  hasty.full_step = 0;
  hasty.growth = 1;
  hasty.patience = 1;
  hasty.raises = 0;
  const auto solver =
      make_direct_solver("interior-point", "monolithic", {}, Settings(), make_interior_point(hasty));
  int solved = 0;
  for (const double cfm : {1e-6, 1e-10, 1e-14}) {
    for (int seed = 0; seed < 20; ++seed) {
      const StepProblem pile = make_pile(seed, {.layers = 5, .cfm = cfm, .mass_ratio = 1e3});
      Solution solution;
      const SolveSummary summary = solve(pile, *solver, solution);
      solved += summary.fallbacks == 0 && is_exact(pile, summary, solution);
    }
  }
  EXPECT_GE(solved, 53);
}

}  // namespace
}  // namespace cleave
