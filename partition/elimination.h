// How much it takes to factor the sparse symmetric matrix of some bodies, 6x6 blocks, an off-diagonal one
// where two bodies share a constraint: counted, not factored.
//
// Bodies are eliminated by minimum degree (Tinney and Walker, Proceedings of the IEEE 55, 1967; George and
// Liu, SIAM Review 31, 1989), the degree counted exactly: the body with the fewest neighbours goes next, the
// lowest place among `bodies` on ties, and its neighbours become neighbours of each other. Bodies of a later
// stage go after all of an earlier one. Solvers order with approximate degrees and join columns, so that
// their counts differ by some percent.
#pragma once

#include <queue>
#include <span>
#include <vector>

#include "partition/body_graph.h"

namespace cleave {

// A block column of the factor.
struct EliminatedColumn {
  int body = 0;
  int below = 0;    // blocks below the diagonal
  int parent = -1;  // place of the column of its first block below; -1 where there is none
};

// Sum of the squared heights of the six columns of a block column: the multiplications and additions of its
// elimination.
double column_flops(int below);

class Eliminator {
 public:
  explicit Eliminator(const BodyGraph& graph) : graph_(graph), local_of_body_(graph.body_count(), -1) {}

  // Columns in order of elimination, of `bodies` and the edges among them. bodies: distinct. stage_of_body:
  // (n), or empty where all are equal. Valid until the next call.
  std::span<const EliminatedColumn> run(std::span<const int> bodies, std::span<const int> stage_of_body = {});

 private:
  struct Candidate {
    int stage, degree, local;
    auto operator<=>(const Candidate&) const = default;
  };

  void find_neighbours(std::span<const int> bodies);
  void push(int local);
  void eliminate(int local);
  void eliminate_clique(std::span<const int> bodies);
  void find_parents();
  void add_column(int local);

  const BodyGraph& graph_;
  std::vector<int> local_of_body_;  // (n): place in `bodies`, -1 for others
  std::vector<std::vector<int>>
      neighbours_;          // by place: those that are left; of an eliminated body, its column
  std::vector<int> place_;  // by place in `bodies`: of its column, -1 while it is left
  std::vector<int> mark_, bodies_, stage_;
  int stamp_ = 0;
  std::priority_queue<Candidate, std::vector<Candidate>, std::greater<>> queue_;
  std::vector<EliminatedColumn> columns_;
};

}  // namespace cleave
