#include "solver/registry.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "solver/step_solver.h"

namespace cleave {
namespace {

TEST(SolverRegistryTest, HasTheNamedSolversAndEveryRowHasHelp) {
  const std::vector<std::string> names = all_solver_names();
  for (const char* name : {"dense", "monolithic", "schur"}) {
    EXPECT_EQ(std::count(names.begin(), names.end(), name), 1) << name;
  }
  for (std::size_t i = 0; i < names.size(); ++i) {
    EXPECT_EQ(std::count(names.begin(), names.end(), names[i]), 1) << names[i];
  }
  const auto check_entry = [](const AlgorithmEntry& entry) {
    EXPECT_STRNE(entry.help, "") << entry.name;
    EXPECT_EQ(std::string_view(entry.help).find('\n'), std::string_view::npos) << entry.name;
    EXPECT_STRNE(entry.reference, "") << entry.name;
  };
  for (const StrategyRow& row : strategy_table()) check_entry(row);
  for (const KernelRow& row : kernel_table()) check_entry(row);
  for (const SolverRow& row : solver_table()) {
    check_entry(row);
    EXPECT_EQ(std::count(names.begin(), names.end(), row.name), 1) << row.name;
  }
}

TEST(SolverRegistryTest, UnknownNamesAreRefused) {
  for (const char* name : {"", "shur", "pivot", "pivot:", ":dense", "pivot:nothing", "nothing:dense",
                           "alternate:dense", "pivot:dense:dense", "schur "}) {
    EXPECT_THROW(make_step_solver(name, {}), std::invalid_argument) << "'" << name << "'";
  }
}

std::string refusal(const std::string& text) {
  try {
    make_step_solver(text);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "";
}

TEST(SolverRegistryTest, ParametersOfOthersAndBadValuesAreRefusedByName) {
  EXPECT_NE(refusal("schur@sweeps=5").find("sweeps is a parameter of pgs, pgs-colored; schur has: max-iterations"),
            std::string::npos)
      << refusal("schur@sweeps=5");
  EXPECT_NE(refusal("pgs@predictor-sweeps=5").find("strategy pivot"), std::string::npos);
  EXPECT_NE(refusal("pgs@sweeps=-1").find("pgs@sweeps: -1 is not in [0, inf)"), std::string::npos);
  EXPECT_NE(refusal("exact@max-iteration=3").find("'max-iterations'?"), std::string::npos);
  EXPECT_EQ(refusal("interior-point:schur-bodies@max-iterations=3@reuse-analysis=true"), "");
}

}  // namespace
}  // namespace cleave
