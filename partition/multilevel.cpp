// multilevel: multilevel bisection by recursion (Karypis and Kumar 1998; Fiduccia and Mattheyses 1982).
//
// A set that is to become k parts is split into two that are to become ceil(k / 2) and floor(k / 2), with
// bodies in the same proportion, until k is 1; at first k = ceil(n / max-bodies). A bisection (bisection.h)
// joins nodes by heavy-edge matching until few are left, grows one side there, and refines on every level on
// the way back. Bounds: a part has at most B = floor((1 + max-growth) max-bodies + 1e-9) bodies; a set that
// is still to be split L = ceil(log2 k) times lends its two sides one L-th of the room that its parts have up
// to B.
//
// effort=fast joins bodies three times before the recursion, to at most seven, and splits what is left; on
// the way back to bodies nodes move between all parts on every level (level_moves.h). effort=best splits
// bodies, tries more starts, lends up to half of what is left of the room beyond that L-th, as the dice fall,
// and moves bodies as in `fm-hill` at the end. The dice also choose the nodes that matching and growing begin
// with.
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <deque>
#include <memory>
#include <numeric>
#include <optional>

#include "harness/base/dice.h"
#include "partition/bisection.h"
#include "partition/gains.h"
#include "partition/level_moves.h"
#include "partition/parameters.h"
#include "partition/registry.h"

namespace cleave {
namespace {

struct Effort {
  const char* name;
  int joinings;         // of bodies, before the recursion
  double more_lending;  // share of the room beyond one L-th
  BisectionOptions bisection;
  const char* last;  // refiner of bodies at the end; nullptr: they move as the nodes of other levels
};

// Where nodes move between all parts afterwards, one pass of short patience from one start will do. On
// thirteen graphs of 200 to 100000 bodies, with 30 coarse nodes and a patience of 5, nodes of six cut as much
// and took a tenth longer; nodes of eight cut a tenth more on one.
constexpr int kMostJoined = 7;
constexpr Effort kEfforts[] = {
    {"fast", 3, 0, {.coarse_nodes = 80, .growths = 1, .patience = 3, .most_passes = 1}, nullptr},
    {"best",
     0,
     0.5,
     {.coarse_nodes = 24, .growths = 3, .patience = 16, .most_passes = 4},
     "fm-hill@patience=40"},
};

// A graph of bodies, joined a number of times.
class JoinedLevels {
 public:
  JoinedLevels(const BodyGraph& graph, EdgeWeight unit, int joinings, int most_joined)
      : levels_(joinings + 1), coarse_of_node_(joinings) {
    Coarsening coarsening;
    levels_[0].take(graph, unit);
    for (int k = 0; k < joinings; ++k) {
      const int nodes = coarsening.match(levels_[k], most_joined, 0, coarse_of_node_[k]);
      coarsening.contract(levels_[k], coarse_of_node_[k], nodes, levels_[k + 1]);
    }
  }

  int joinings() const { return static_cast<int>(coarse_of_node_.size()); }
  const LevelGraph& operator[](int level) const { return levels_[level]; }

  // Of the nodes of a level: the node of the next one that each was joined to.
  std::span<const int> coarse_of_node(int level) const { return coarse_of_node_[level]; }

 private:
  std::vector<LevelGraph> levels_;
  std::vector<std::vector<int>> coarse_of_node_;  // by level, of its nodes
};

// Parts of the nodes of a graph.
class Recursion {
 public:
  Recursion(const Effort& effort, int most_bodies, Dice& dice)
      : bisection_(effort.bisection),
        more_lending_(effort.more_lending),
        most_bodies_(most_bodies),
        dice_(dice) {}

  Partition run(const LevelGraph& graph, int parts) {
    partition_.part_of_body.resize(graph.node_count());
    std::vector<int> nodes(graph.node_count());
    std::iota(nodes.begin(), nodes.end(), 0);
    split(graph, nodes, parts, 0);
    return std::move(partition_);
  }

 private:
  struct Depth {
    std::array<LevelGraph, 2> halves;
    std::array<std::vector<int>, 2> nodes;
    std::vector<char> side;
  };

  // nodes: of the whole graph, by node of this one.
  void split(const LevelGraph& graph, const std::vector<int>& nodes, int parts, std::size_t depth) {
    if (parts == 1) {
      for (const int node : nodes) partition_.part_of_body[node] = partition_.part_count;
      ++partition_.part_count;
      return;
    }
    if (depth == depths_.size()) depths_.emplace_back();
    Depth& here = depths_[depth];
    bisect(graph, parts, here.side);
    graph.split(here.side, here.halves, here.nodes, place_);
    for (int s = 0; s < 2; ++s) {
      for (int& node : here.nodes[s]) node = nodes[node];
      const int of_side = s == 0 ? (parts + 1) / 2 : parts / 2;
      if (!here.nodes[s].empty()) split(here.halves[s], here.nodes[s], of_side, depth + 1);
    }
  }

  void bisect(const LevelGraph& graph, int parts, std::vector<char>& side) {
    const int bodies = graph.body_count();
    const std::array<int, 2> of_side{(parts + 1) / 2, parts / 2};
    const double each = static_cast<double>(bodies) / parts;
    const double lent = (most_bodies_ - each) * lent_share(parts);
    std::array<int, 2> most{};
    for (int s = 0; s < 2; ++s) {
      most[s] = static_cast<int>(std::ceil(of_side[s] * (each + lent) - 1e-9));
      most[s] = std::min({most[s], of_side[s] * most_bodies_, std::max(1, bodies - of_side[1 - s])});
    }
    bisection_.run(graph, static_cast<int>(std::lround(of_side[0] * each)), most, dice_, side);
  }

  double lent_share(int parts) {
    const double least = 1.0 / std::bit_width(static_cast<unsigned>(parts - 1));
    if (more_lending_ == 0) return least;
    return least + more_lending_ * (1 - least) * static_cast<double>(dice_.below(1000)) / 1000;
  }

  Bisection bisection_;
  const double more_lending_;
  const int most_bodies_;
  Dice& dice_;
  std::deque<Depth> depths_;
  std::vector<int> place_;
  Partition partition_;
};

// Bodies of parts above the bound move where that costs least, or to the part of fewest bodies where none
// next to them has room. Nodes of several bodies may have left some.
class Unloading {
 public:
  Unloading(const BodyGraph& graph, EdgeWeight unit, int most_bodies, Partition& partition)
      : gains_(graph, unit, partition.part_count),
        most_bodies_(most_bodies),
        part_of_body_(partition.part_of_body),
        bodies_(part_sizes(partition)) {}

  void run() {
    for (int part = 0; part < static_cast<int>(bodies_.size()); ++part)
      while (bodies_[part] > most_bodies_) move(to_neighbour(part).value_or(anywhere(part)), part);
  }

 private:
  // The best move of one of its bodies to a part beside it that has room, if there is any.
  std::optional<Exchange> to_neighbour(int part) {
    std::optional<Exchange> best;
    for (int body = 0; body < static_cast<int>(part_of_body_.size()); ++body) {
      if (part_of_body_[body] != part) continue;
      for (const MoveGain& move : gains_.of(body, part_of_body_)) {
        const Exchange exchange{move.gain, body, move.part, 0};
        if (bodies_[move.part] < most_bodies_ && (!best || *best < exchange)) best = exchange;
      }
    }
    return best;
  }

  // Its lowest body to the part of fewest bodies.
  Exchange anywhere(int part) const {
    const auto first = std::ranges::find(part_of_body_, part) - part_of_body_.begin();
    const auto smallest = std::ranges::min_element(bodies_) - bodies_.begin();
    return {0, static_cast<int>(first), static_cast<int>(smallest), 0};
  }

  void move(const Exchange& exchange, int from) {
    part_of_body_[exchange.first] = exchange.second;
    --bodies_[from];
    ++bodies_[exchange.second];
  }

  MoveGains gains_;
  const int most_bodies_;
  std::vector<int>& part_of_body_;
  std::vector<int> bodies_;  // by part
};

class Multilevel final : public Partitioner {
 public:
  explicit Multilevel(const Settings& settings)
      : max_bodies_(settings.integer("max-bodies")),
        max_growth_(settings.number("max-growth")),
        unit_(settings.word<EdgeWeight>(parameters::edge_weight())),
        seed_(settings.integer("partition-seed")),
        effort_(*std::ranges::find(kEfforts, settings.text("effort"),
                                   [](const Effort& e) { return std::string(e.name); })),
        last_(effort_.last == nullptr
                  ? nullptr
                  : make_refiner(effort_.last + std::string("@max-growth=") + settings.text("max-growth") +
                                 "@edge-weight=" + settings.text("edge-weight"))) {}

 private:
  Partition do_run(const BodyGraph& graph) const override {
    const int n = graph.body_count();
    if (n <= max_bodies_) return {std::vector<int>(n, 0), n > 0 ? 1 : 0};
    const int most_bodies = std::min(n, most_grown_bodies(max_bodies_, max_growth_));
    Dice dice(seed_);
    const JoinedLevels levels(graph, unit_, effort_.joinings, std::min(kMostJoined, most_bodies));
    Recursion recursion(effort_, most_bodies, dice);
    Partition partition = recursion.run(levels[levels.joinings()], wanted_parts(n, max_bodies_));
    LevelMoves moves(partition.part_count, most_bodies);
    std::vector<int> scratch;
    for (int k = levels.joinings(); k > 0; --k) {
      moves.run(levels[k], partition.part_of_body);
      give_to_finer(levels.coarse_of_node(k - 1), partition.part_of_body, scratch);
    }
    Unloading(graph, unit_, most_bodies, partition).run();
    if (last_ == nullptr) {
      moves.run(levels[0], partition.part_of_body);
    } else {
      last_->run(graph, max_bodies_, partition);
    }
    return numbered_by_lowest_body(partition.part_of_body);  // without empty ones
  }

  int max_bodies_;
  double max_growth_;
  EdgeWeight unit_;
  int seed_;
  Effort effort_;
  std::unique_ptr<Refiner> last_;  // nullptr for none
};

}  // namespace

std::unique_ptr<Partitioner> make_multilevel(const Settings& settings) {
  return std::make_unique<Multilevel>(settings);
}

}  // namespace cleave
