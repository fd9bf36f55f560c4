// steps.csv of one thread and of two, byte for byte but for times and the thread count: every splitting
// solver, parts of every partitioner, and steps on which the bodies form several islands.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>

#include "harness/base/names.h"
#include "solver/registry.h"
#include "tests/harness/machine_columns.h"
#include "tests/harness/run_program.h"

namespace cleave {
namespace {

// All strategies on the kernels that split, and one solver that does not.
std::string splitting_solvers() {
  Arguments names = {"exact"};
  for (const StrategyRow& strategy : strategy_table())
    for (const KernelRow& kernel : kernel_table())
      if (kernel.traits.splits && runs_on(strategy, kernel))
        names.push_back(std::string(strategy.name) + ":" + kernel.name);
  return joined(names, ",");
}

CsvTable run_on(const std::string& threads, const Arguments& scene) {
  const TemporaryDirectory directory;
  Arguments arguments = {"run",
                         "--threads",
                         threads,
                         "--solver",
                         splitting_solvers(),
                         "--max-bodies",
                         "6",
                         "--repeats",
                         "1",
                         "--partitioner",
                         "all",
                         "--refiner",
                         "fm",
                         "--advance",
                         "schur",
                         "--out",
                         directory / "out"};
  arguments.insert(arguments.end(), scene.begin(), scene.end());
  const ProgramResult result = run_cleave(arguments);
  EXPECT_TRUE(result.exit_code == 0 || result.exit_code == 2) << result.err;  // alternate may miss
  return read_csv(directory / "out/steps.csv");
}

void expect_equal_but_for_times(const CsvTable& one, const CsvTable& two) {
  ASSERT_EQ(one.header, two.header);
  ASSERT_EQ(one.rows.size(), two.rows.size());
  int compared = 0;
  for (const std::string& column : one.header) {
    if (is_of_the_machine(column)) continue;
    EXPECT_EQ(one.column(column), two.column(column)) << column;
    ++compared;
  }
  EXPECT_GT(compared, 60);
}

TEST(Threads, TwoGiveTheBytesOfOneForEverySplittingSolver) {
  ::setenv("OMP_WAIT_POLICY", "passive", 1);  // threads that spin for work are slow where cores are shared
  for (const Arguments& scene :
       {Arguments{"--scene", "rock_pile", "--bodies", "40", "--steps", "120", "--measure-every", "60"},
        Arguments{"--scene", "log_tower", "--layers", "5", "--logs", "3", "--steps", "100", "--measure-every",
                  "50"}}) {
    SCOPED_TRACE(joined(scene, " "));
    const CsvTable one = run_on("1", scene), two = run_on("2", scene);
    expect_equal_but_for_times(one, two);
    EXPECT_EQ(one.at(0, "threads"), "1");
    EXPECT_EQ(two.at(0, "threads"), "2");
    const auto most = [&](const char* column) {
      int largest = 0;
      for (const std::string& cell : one.column(column)) largest = std::max(largest, std::stoi(cell));
      return largest;
    };
    EXPECT_GE(most("parts"), 3);
    EXPECT_GE(most("interface_unknowns"), 40);
    if (scene[1] == "rock_pile") {
      EXPECT_GE(most("islands"), 2);
    }
  }
}

}  // namespace
}  // namespace cleave
