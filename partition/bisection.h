// Splits a graph into two sides with little weight between them, each side with no more bodies than its
// bound.
//
// Two-way refinement after Fiduccia and Mattheyses (1982), with hill-climbing: in a pass every node may move
// once; always the allowed move of greatest gain is made, be it negative; the pass ends when nothing is left
// to move or more than `patience` moves in a row brought nothing, and is taken back to its best moment.
// Passes follow until one brings nothing. A move is allowed if the side that it goes to stays within its
// bound, or is filled less (in bodies above the bound) than the other. A moment is better if fewer bodies are
// above the bounds, then if the cut weighs less.
#pragma once

#include <array>
#include <vector>

#include "harness/base/dice.h"
#include "partition/level_graph.h"

namespace cleave {

struct BisectionOptions {
  int coarse_nodes = 60;  // coarsening ends here
  int growths = 4;        // starts tried on the coarsest graph
  int patience = 30;
  int most_passes = 4;
};

class Bisection {
 public:
  explicit Bisection(const BisectionOptions& options) : options_(options) {}

  // side (nodes): 0 or 1. wanted: bodies of side 0; most: of either side. Returns the weight of the cut.
  long run(const LevelGraph& graph, int wanted, std::array<int, 2> most, Dice& dice, std::vector<char>& side);

 private:
  struct Moment {
    long above = 0, cut = 0;
    bool operator<(const Moment& other) const {
      return above != other.above ? above < other.above : cut < other.cut;
    }
  };

  int coarsen(const LevelGraph& graph, Dice& dice);
  void grow(const LevelGraph& graph, int wanted, int seed, std::vector<char>& side);
  long start(const LevelGraph& graph, int wanted, Dice& dice, std::vector<char>& side);
  Moment refine(const LevelGraph& graph, std::vector<char>& side);
  Moment take(const LevelGraph& graph, const std::vector<char>& side);
  bool pass(const LevelGraph& graph, std::vector<char>& side, Moment& now);
  int choose(const LevelGraph& graph);
  int best(const LevelGraph& graph, int side);
  void move(const LevelGraph& graph, int node, std::vector<char>& side);
  int farthest(const LevelGraph& graph, int seed);
  bool is_allowed(int node_bodies, int from) const;
  long above() const;
  void insert(int node, int side);
  void remove(int node, int side);

  BisectionOptions options_;
  std::array<int, 2> most_{}, filled_{};  // bodies
  Coarsening coarsening_;
  std::vector<LevelGraph> levels_;                // levels_[0] is unused: it is the graph given
  std::vector<std::vector<int>> coarse_of_node_;  // of each level
  std::vector<int> gain_, queue_, moved_;
  std::vector<char> state_, trial_, finer_;
  // Nodes by side and gain, in doubly linked lists; -1 outside of refine().
  std::array<std::vector<int>, 2> bucket_;
  std::vector<int> next_, previous_;
  std::array<int, 2> top_{};
  int offset_ = 0;
};

}  // namespace cleave
