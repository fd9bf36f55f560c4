// Partitioners of METIS and SCOTCH: what these libraries share with the whole process stays as it was, and
// the same parts come out whatever happened before and beside.
#include <gtest/gtest.h>
#include <signal.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cstdlib>
#include <iterator>
#include <thread>

#include "partition/registry.h"
#include "tests/partition/printed_rows.h"
#include "tests/partition/test_graphs.h"

namespace cleave::partition_test {
namespace {

std::vector<PartitionerEntry> rows_of_libraries() {
  std::vector<PartitionerEntry> rows;
  std::ranges::copy_if(partitioners(), std::back_inserter(rows), [](const PartitionerEntry& entry) {
    const std::string name = entry.name;
    return (name.starts_with("metis") || name == "scotch") && entry.unavailable.empty();
  });
  return rows;
}

BodyGraph large_pile(std::uint64_t seed) {
  Random random(seed);
  return pile(random, 10, 10, 10).graph();
}

Bodies clique(int first, int bodies, Bodies to = {}) {
  for (int a = first; a < first + bodies; ++a) {
    to.mass_kg.push_back(1);
    for (int b = first; b < a; ++b) to.links.push_back({a, b, 3});
  }
  return to;
}

class LibraryPartitioner : public testing::TestWithParam<PartitionerEntry> {
 protected:
  Partition run(const BodyGraph& graph, const std::string& parameters = "") const {
    return make_partitioner(GetParam().name + parameters)->run(graph);
  }
};

TEST_P(LibraryPartitioner, gives_the_same_parts_after_anything_else) {
  const BodyGraph graph = large_pile(1);
  const Partition expected = run(graph);
  for (const PartitionerEntry& other : rows_of_libraries()) {
    std::srand(99);
    make_partitioner(other.name + std::string("@partition-seed=7"))->run(large_pile(2));
    EXPECT_EQ(first_difference(expected, run(graph)), "") << "after " << other.name;
  }
}

TEST_P(LibraryPartitioner, gives_the_same_parts_beside_others) {
  const BodyGraph graph = large_pile(1);
  const Partition expected = run(graph);
  for (const PartitionerEntry& other : rows_of_libraries()) {
    std::thread beside([&] { make_partitioner(other.name)->run(graph); });
    const Partition found = run(graph);
    beside.join();
    EXPECT_EQ(first_difference(expected, found), "") << "beside " << other.name;
  }
}

TEST_P(LibraryPartitioner, leaves_the_dice_of_the_c_library_alone) {
  const BodyGraph graph = large_pile(1);
  std::srand(5);
  const int first = std::rand(), second = std::rand();
  std::srand(5);
  EXPECT_EQ(std::rand(), first);
  run(graph);
  EXPECT_EQ(std::rand(), second);
}

std::atomic<int> signals_taken{0};
void take(int) { ++signals_taken; }

// A handler of the test's own for a signal, and at the end the one that was there.
class Handler {
 public:
  explicit Handler(int signal) : signal_(signal) {
    struct sigaction own {};
    own.sa_handler = take;
    own.sa_flags = SA_RESTART;
    ::sigaddset(&own.sa_mask, SIGUSR1);
    ::sigaction(signal, &own, &before_);
  }
  ~Handler() { ::sigaction(signal_, &before_, nullptr); }

  // Whether the test's own is in place.
  bool stands() const {
    struct sigaction found {};
    ::sigaction(signal_, nullptr, &found);
    return found.sa_handler == take && (found.sa_flags & ~0x04000000) == SA_RESTART &&
           ::sigismember(&found.sa_mask, SIGUSR1) == 1;
  }

 private:
  int signal_;
  struct sigaction before_ {};
};

TEST_P(LibraryPartitioner, leaves_signals_alone) {
  const Handler abort(SIGABRT), terminate(SIGTERM), interrupt(SIGINT);
  sigset_t before, after;
  ::pthread_sigmask(SIG_BLOCK, nullptr, &before);
  run(large_pile(1));
  ::pthread_sigmask(SIG_BLOCK, nullptr, &after);
  EXPECT_TRUE(abort.stands());
  EXPECT_TRUE(terminate.stands());
  EXPECT_TRUE(interrupt.stands());
  for (int signal = 1; signal < SIGRTMIN; ++signal)
    EXPECT_EQ(::sigismember(&before, signal), ::sigismember(&after, signal)) << signal;
}

// While METIS has a handler of its own in place the program's still gets the signal, once the call is over.
TEST_P(LibraryPartitioner, hands_on_a_signal_that_comes_during_a_call) {
  if (std::string(GetParam().name) == "scotch") return;  // it has none
  const BodyGraph graph = large_pile(1);
  const Partition expected = run(graph);
  const Handler terminate(SIGTERM);
  signals_taken = 0;
  std::atomic<bool> sent{false};
  sigset_t stop, before;
  ::sigemptyset(&stop);
  ::sigaddset(&stop, SIGTERM);
  ::pthread_sigmask(SIG_BLOCK, &stop, &before);  // the sender is not to take it itself
  std::thread sender([&] {
    while (terminate.stands()) continue;
    ::kill(::getpid(), SIGTERM);
    sent = true;
  });
  ::pthread_sigmask(SIG_SETMASK, &before, nullptr);
  while (!sent) EXPECT_EQ(first_difference(expected, run(graph)), "");
  sender.join();
  EXPECT_EQ(signals_taken, 1);
  EXPECT_TRUE(terminate.stands());
}

// Not all that are asked for have bodies when parts are small.
TEST_P(LibraryPartitioner, asks_for_as_many_parts_as_bodies_need) {
  const BodyGraph graph = large_pile(1);
  EXPECT_EQ(run(graph).part_count, 40);
  for (const int max_bodies : {1, 2, 40, 333, 999, 1000, 5000})
    EXPECT_LE(run(graph, "@max-bodies=" + std::to_string(max_bodies)).part_count,
              (1000 + max_bodies - 1) / max_bodies)
        << max_bodies;
}

// With nothing to choose bodies go by index.
TEST_P(LibraryPartitioner, splits_graphs_without_edges_by_index) {
  const BodyGraph loose(std::vector<double>(10, 1.0), {});
  EXPECT_EQ(run(loose, "@max-bodies=3").part_of_body, (std::vector<int>{0, 0, 0, 1, 1, 2, 2, 2, 3, 3}));
  EXPECT_EQ(run(loose, "@max-bodies=1").part_count, 10);
  EXPECT_EQ(run(loose).part_count, 1);
  EXPECT_EQ(run(clique(0, 3).graph(), "@max-bodies=1").part_of_body, (std::vector<int>{0, 1, 2}));
}

TEST_P(LibraryPartitioner, finds_the_least_cut_where_it_is_plain) {
  Bodies apart = clique(20, 20, clique(0, 20));
  EXPECT_EQ(measure_partition(apart.graph(), run(apart.graph(), "@max-bodies=20").part_of_body).cut_pairs, 0);
  apart.links.push_back({3, 30, 3});
  const Partition bridged = run(apart.graph(), "@max-bodies=20");
  EXPECT_EQ(bridged.part_count, 2);
  EXPECT_EQ(measure_partition(apart.graph(), bridged.part_of_body).cut_pairs, 1);
}

TEST_P(LibraryPartitioner, cuts_less_of_what_it_weighs) {
  long weighed = 0, counted = 0;
  for (std::uint64_t seed = 0; seed < 8; ++seed) {
    const BodyGraph graph = large_pile(seed);
    weighed += cut_weight(graph, run(graph, "@edge-weight=rows").part_of_body, EdgeWeight::rows);
    counted += cut_weight(graph, run(graph, "@edge-weight=pairs").part_of_body, EdgeWeight::rows);
  }
  EXPECT_LT(weighed, counted);
}

// Each parameter reaches the library: some value of it changes the parts. metis-kway draws by its seed only
// while it coarsens, down to 30 bodies a part.
TEST_P(LibraryPartitioner, heeds_all_its_parameters) {
  const BodyGraph graph = large_pile(1);
  const std::string large_parts = "@max-bodies=60";
  EXPECT_NE(first_difference(run(graph, large_parts), run(graph, large_parts + "@partition-seed=2")), "");
  const Partition usual = run(graph);
  std::vector<std::string> values = {"@max-growth=0.02", "@max-bodies=20"};
  const std::string name = GetParam().name;
  if (name == "scotch")
    values.insert(values.end(), {"@scotch-strategy=quality", "@scotch-strategy=balance"});
  else
    values.push_back("@ufactor=500");
  for (const std::string& value : values) EXPECT_NE(first_difference(usual, run(graph, value)), "") << value;
}

// More room for a part, less cut; and the factor given is the one that max-growth stands for.
TEST(Metis, ufactor_is_the_room_that_max_growth_gives) {
  if (std::ranges::none_of(rows_of_libraries(),
                           [](const auto& row) { return row.name == std::string("metis-kway"); }))
    GTEST_SKIP() << "a build without METIS (libmetis-dev)";
  const BodyGraph graph = large_pile(1);  // 40 parts of 25: ceil(log2 40) = 6 halvings, 1.2^(1/6) = 1.0308
  const auto parts_of = [&](const std::string& text) { return make_partitioner(text)->run(graph); };
  EXPECT_EQ(first_difference(parts_of("metis-kway"), parts_of("metis-kway@ufactor=200")), "");
  EXPECT_EQ(first_difference(parts_of("metis-recursive"), parts_of("metis-recursive@ufactor=30")), "");
  EXPECT_NE(first_difference(parts_of("metis-kway"), parts_of("metis-kway@ufactor=30")), "");
}

constexpr auto kRowName = [](const auto& info) {
  std::string name = info.param.name;
  std::ranges::replace(name, '-', '_');
  return name;
};
GTEST_ALLOW_UNINSTANTIATED_PARAMETERIZED_TEST(LibraryPartitioner);  // in a build without these libraries
INSTANTIATE_TEST_SUITE_P(All, LibraryPartitioner, testing::ValuesIn(rows_of_libraries()), kRowName);

}  // namespace
}  // namespace cleave::partition_test
