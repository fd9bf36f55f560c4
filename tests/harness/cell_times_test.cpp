#include "harness/campaign/cell_times.h"

#include <gtest/gtest.h>

namespace cleave {
namespace {

CampaignCell cell_of(const std::string& scene, const std::string& seed) {
  CampaignCell cell;
  cell.options = {{"scene", scene}, {"seed", seed}};
  return cell;
}

TEST(CellTimes, NearestFinishedCellsTell) {
  CellTimes times;
  EXPECT_FALSE(times.of(cell_of("rock_pile", "1")));
  times.add(cell_of("chain_drop", "1"), 3);
  EXPECT_EQ(times.of(cell_of("rock_pile", "1")), 3);
  times.add(cell_of("rock_pile", "1"), 9);
  EXPECT_EQ(times.of(cell_of("rock_pile", "2")), 9);
  EXPECT_EQ(times.of(cell_of("log_tower", "1")), 6);
}

// A pile that runs for minutes after chains of seconds must not be expected to end in seconds.
TEST(CellTimes, CellThatRunsOnLiftsWhatIsExpected) {
  CellTimes times;
  times.add_running(cell_of("rock_pile", "1"), 100, {});
  EXPECT_FALSE(times.of(cell_of("rock_pile", "1"))) << "nothing has ended";
  times.add(cell_of("chain_drop", "1"), 3);
  times.add_running(cell_of("rock_pile", "1"), 2, {});
  EXPECT_EQ(times.of(cell_of("rock_pile", "1")), 3) << "not longer than expected";
  times.add_running(cell_of("rock_pile", "1"), 100, {});
  EXPECT_EQ(times.of(cell_of("rock_pile", "1")), 200);
  EXPECT_EQ(times.of(cell_of("rock_pile", "2")), 200);
}

TEST(CellTimes, CellThatSaysWhatItExpectsIsBelieved) {
  CellTimes times;
  times.add_running(cell_of("rock_pile", "1"), 10, 60);
  EXPECT_EQ(times.of(cell_of("rock_pile", "1")), 60) << "before any has ended";
  EXPECT_EQ(times.of(cell_of("chain_drop", "1")), 60);
  CellTimes late;
  late.add_running(cell_of("rock_pile", "1"), 70, 60);
  EXPECT_EQ(late.of(cell_of("rock_pile", "1")), 70) << "it runs longer than it expected";
}

}  // namespace
}  // namespace cleave
