// karger: random contraction, which Liu & Andrews 2022 tried before they grew parts.
//
// karger-method contract: n single bodies are contracted (contraction.h) until
//
//     k = ceil(n / max-bodies)
//
// nodes are left, or no edge that may be: one that would make a node of more than
//
//     floor((1 + max-growth) max-bodies + 1e-9)
//
// bodies is refused. The nodes are the parts, also those beyond k: islands, and what was refused.
//
// karger-method recursive-bisection: every island is a set; a set of more than max-bodies bodies is split
// along a minimum cut (karger_stein.h), and so are both sides, the one with the lowest body first. Such cuts
// know no balance.
//
// Either is tried `trials` times with dice of seed partition-seed, which go on from one trial to the next.
// The trial with the least cut, in edge-weight, counts; of several that with the fewest parts, then the
// earliest.
#include <algorithm>
#include <memory>
#include <utility>

#include "harness/base/parameter.h"
#include "harness/base/stop.h"
#include "harness/base/stop_signals.h"
#include "partition/contraction.h"
#include "partition/karger_stein.h"
#include "partition/parameters.h"
#include "partition/partitioner.h"

namespace cleave {
namespace {

// Sets that are still to be looked at are on a stack: minimum cuts may split off one body at a time.
class Bisections {
 public:
  Bisections(const BodyGraph& graph, EdgeWeight unit, int max_bodies)
      : unit_(unit), max_bodies_(max_bodies), label_of_body_(graph.body_count()) {
    std::vector<int> bodies(graph.body_count()), island_of_body;
    for (int body = 0; body < graph.body_count(); ++body) bodies[body] = body;
    const int islands = count_islands(graph, &island_of_body);
    open(graph, bodies, island_of_body, islands);
  }

  Partition run(Dice& dice) {
    while (!open_.empty()) {
      check_stop(&stop_requested());
      const Set set = std::move(open_.back());
      open_.pop_back();
      const int n = set.graph.body_count();
      if (n <= max_bodies_) {
        for (const int body : set.bodies) label_of_body_[body] = labels_;
        ++labels_;
      } else {
        open(set.graph, set.bodies, karger_stein(n, edges_of(set.graph, unit_), dice).side_of_node, 2);
      }
    }
    return numbered_by_lowest_body(label_of_body_);
  }

 private:
  struct Set {
    BodyGraph graph;
    std::vector<int> bodies;  // of the whole graph, ascending
  };

  // The first set is taken first.
  void open(const BodyGraph& graph, std::span<const int> bodies, std::span<const int> set_of_body, int sets) {
    std::vector<BodyGraph> graphs = graph.induced(set_of_body, sets);
    std::vector<Set> opened(sets);
    for (int k = 0; k < graph.body_count(); ++k) opened[set_of_body[k]].bodies.push_back(bodies[k]);
    for (int set = sets - 1; set >= 0; --set)
      open_.push_back({std::move(graphs[set]), std::move(opened[set].bodies)});
  }

  EdgeWeight unit_;
  int max_bodies_;
  std::vector<Set> open_;
  std::vector<int> label_of_body_;  // (n)
  int labels_ = 0;
};

class Karger final : public Partitioner {
 public:
  explicit Karger(const Settings& settings)
      : max_bodies_(settings.integer("max-bodies")),
        grown_bodies_(most_grown_bodies(max_bodies_, settings.number("max-growth"))),
        unit_(settings.word<EdgeWeight>(parameters::edge_weight())),
        seed_(settings.integer("partition-seed")),
        trials_(settings.integer("trials")),
        bisects_(settings.text("karger-method") == "recursive-bisection") {}

 private:
  Partition do_run(const BodyGraph& graph) const override {
    Dice dice(seed_);
    Partition best;
    std::pair<long, int> best_is;  // cut, parts
    const std::vector<WeightedEdge> edges = edges_of(graph, unit_);
    for (int trial = 0; trial < trials_; ++trial) {
      check_stop(&stop_requested());  // there may be millions
      Partition found =
          bisects_ ? Bisections(graph, unit_, max_bodies_).run(dice) : contracted(graph, edges, dice);
      const std::pair found_is{cut_weight(graph, found.part_of_body, unit_), found.part_count};
      if (trial > 0 && found_is >= best_is) continue;
      best = std::move(found);
      best_is = found_is;
    }
    return best;
  }

  Partition contracted(const BodyGraph& graph, std::span<const WeightedEdge> edges, Dice& dice) const {
    const int n = graph.body_count();
    Contraction nodes = contract(n, edges, {wanted_parts(n, max_bodies_), grown_bodies_}, dice);
    return {std::move(nodes.node_of_body), nodes.node_count};
  }

  int max_bodies_, grown_bodies_;
  EdgeWeight unit_;
  int seed_, trials_;
  bool bisects_;
};

}  // namespace

std::unique_ptr<Partitioner> make_karger(const Settings& settings) {
  return std::make_unique<Karger>(settings);
}

}  // namespace cleave
