// scotch: the library SCOTCH splits the graph into k = ceil(n / max-bodies) parts of about as many bodies
// each, so that little edge weight is cut, by recursive bisection or k-way refinement on many levels as its
// strategy says (Pellegrini & Roman 1996, HPCN Europe, 493-498; SCOTCH 7.0 user's guide,
// SCOTCH_stratGraphMapBuild).
//
// It is told that parts may differ from n / k by the share at which the largest keeps to floor((1 +
// max-growth) max-bodies) bodies. It takes that as an aim: partition/README.md counts how often a part is
// larger.
//
// Every call has a context of its own, with one thread and its own dice: left alone, SCOTCH draws from dice
// of the process and takes all processors, and its parts depend on how many there are. Where it fails it
// writes a line to stderr and returns; the linked library of errors is the one that does not end the process.
#include <cstdint>
#include <cstdio>
// After these two, which it needs and does not include.
#include <scotch.h>

#include <algorithm>
#include <memory>
#include <mutex>
#include <stdexcept>
#include <string>
#include <vector>

#include "partition/library_graph.h"
#include "partition/parameters.h"
#include "partition/partitioner.h"

namespace cleave {
namespace {

// Places in kFlags, as the words of scotch-strategy stand.
enum class Strategy {};
constexpr SCOTCH_Num kFlags[] = {SCOTCH_STRATDEFAULT, SCOTCH_STRATQUALITY, SCOTCH_STRATSPEED,
                                 SCOTCH_STRATBALANCE, SCOTCH_STRATSAFETY};

void check(int status, const char* what) {
  if (status != 0) throw std::runtime_error(std::string("SCOTCH failed: ") + what);
}

template <class Object, int (*begin)(Object*), void (*end)(Object*)>
class Owned {
 public:
  Owned() { check(begin(&object_), "to begin"); }
  Owned(const Owned&) = delete;
  Owned& operator=(const Owned&) = delete;
  ~Owned() { end(&object_); }
  operator Object*() { return &object_; }

 private:
  Object object_;
};
using Graph = Owned<SCOTCH_Graph, SCOTCH_graphInit, SCOTCH_graphExit>;
using Context = Owned<SCOTCH_Context, SCOTCH_contextInit, SCOTCH_contextExit>;
using StrategyTree = Owned<SCOTCH_Strat, SCOTCH_stratInit, SCOTCH_stratExit>;

class Scotch final : public Partitioner {
 public:
  explicit Scotch(const Settings& settings)
      : max_bodies_(settings.integer("max-bodies")),
        max_growth_(settings.number("max-growth")),
        unit_(settings.word<EdgeWeight>(parameters::edge_weight())),
        seed_(settings.integer("partition-seed")),
        flags_(kFlags[static_cast<int>(settings.word<Strategy>(parameters::scotch_strategy()))]) {}

 private:
  Partition do_run(const BodyGraph& graph) const override {
    const int parts = wanted_parts(graph.body_count(), max_bodies_);
    if (std::optional<Partition> split = split_without_choice(graph, parts)) return *std::move(split);
    const double most = std::min(graph.body_count(), most_grown_bodies(max_bodies_, max_growth_));
    // The user's guide promises nothing for several calls at once.
    static std::mutex one_at_a_time;
    const std::scoped_lock lock(one_at_a_time);
    StrategyTree strategy;
    const double imbalance = most * parts / graph.body_count() - 1;
    check(SCOTCH_stratGraphMapBuild(strategy, flags_, parts, imbalance), "to build its strategy");
    return split(graph, parts, strategy);
  }

  Partition split(const BodyGraph& graph, int parts, StrategyTree& strategy) const {
    const LibraryGraph<SCOTCH_Num> arrays(graph, unit_);
    Graph plain;
    check(SCOTCH_graphBuild(plain, 0, graph.body_count(), arrays.first.data(), nullptr, nullptr, nullptr,
                            static_cast<SCOTCH_Num>(arrays.neighbour.size()), arrays.neighbour.data(),
                            arrays.weight.data()),
          "to take the graph");
    Context context;
    check(SCOTCH_contextRandomClone(context), "to make its dice");
    SCOTCH_contextRandomSeed(context, seed_);
    SCOTCH_contextRandomReset(context);
    check(SCOTCH_contextThreadSpawn(context, 1, nullptr), "to keep to one thread");
    Graph bound;
    check(SCOTCH_contextBindGraph(context, plain, bound), "to bind the graph");
    std::vector<SCOTCH_Num> part_of_body(graph.body_count());
    check(SCOTCH_graphPart(bound, parts, strategy, part_of_body.data()), "to split the graph");
    return numbered_by_lowest_body(std::vector<int>(part_of_body.begin(), part_of_body.end()));
  }

  int max_bodies_;
  double max_growth_;
  EdgeWeight unit_;
  int seed_;
  SCOTCH_Num flags_;
};

}  // namespace

std::unique_ptr<Partitioner> make_scotch(const Settings& settings) {
  return std::make_unique<Scotch>(settings);
}

}  // namespace cleave
