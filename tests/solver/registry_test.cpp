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
  const auto check_entry = [](const SolverEntry& entry) {
    EXPECT_STRNE(entry.help, "") << entry.name;
    EXPECT_EQ(std::string_view(entry.help).find('\n'), std::string_view::npos) << entry.name;
    EXPECT_STRNE(entry.reference, "") << entry.name;
  };
  for (const StrategyRow& row : strategy_table()) check_entry(row.entry);
  for (const KernelRow& row : kernel_table()) check_entry(row.entry);
  for (const SolverRow& row : solver_table()) {
    check_entry(row.entry);
    EXPECT_EQ(std::count(names.begin(), names.end(), row.entry.name), 1) << row.entry.name;
  }
}

TEST(SolverRegistryTest, UnknownNamesAreRefused) {
  for (const char* name : {"", "shur", "pivot", "pivot:", ":dense", "pivot:nothing", "nothing:dense",
                           "alternate:dense", "pivot:dense:dense", "schur "}) {
    EXPECT_THROW(make_step_solver(name, {}), std::invalid_argument) << "'" << name << "'";
  }
}

}  // namespace
}  // namespace cleave
