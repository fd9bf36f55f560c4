// A row of a library that was not there at build, made up here: every way to name it ends in words.
#include <gtest/gtest.h>

#include <stdexcept>

#include "partition/registry.h"

namespace cleave::partition_test {
namespace {

AlgorithmEntry absent_row() {
  return {"absent", "splits by a library", "nowhere", {}, nullptr, "install libabsent-dev and build again"};
}

TEST(UnavailableRow, is_refused_in_one_line_that_names_the_package) {
  try {
    check_available("--partitioner", absent_row());
    ADD_FAILURE() << "accepted";
  } catch (const std::invalid_argument& error) {
    EXPECT_STREQ(error.what(),
                 "--partitioner: absent is not in this build: install libabsent-dev and build again");
  }
}

TEST(UnavailableRow, is_left_out_of_all_with_the_reason) {
  EXPECT_EQ(reason_to_leave_out(absent_row(), {}),
            "is not in this build: install libabsent-dev and build again");
  const AlgorithmEntry present{"present", "splits", "nowhere", {}};
  EXPECT_EQ(reason_to_leave_out(present, {}), "");
  EXPECT_EQ(unavailable_text(present), "");
  EXPECT_NO_THROW(check_available("--partitioner", present));
}

// A row can be made or says what it takes to have it, and keeps its parameters either way.
TEST(UnavailableRow, is_the_only_one_without_a_factory) {
  for (const PartitionerEntry& entry : partitioners()) {
    EXPECT_EQ(entry.make == nullptr, !entry.unavailable.empty()) << entry.name;
    if (entry.unavailable.empty()) continue;
    EXPECT_TRUE(entry.unavailable.starts_with("install lib")) << entry.unavailable;
    EXPECT_FALSE(entry.parameters.empty()) << entry.name;
    try {
      make_partitioner(entry.name);
      ADD_FAILURE() << entry.name << " was made";
    } catch (const std::invalid_argument& error) {
      EXPECT_NE(std::string(error.what()).find(entry.unavailable), std::string::npos) << error.what();
    }
  }
}

}  // namespace
}  // namespace cleave::partition_test
