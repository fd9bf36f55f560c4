// The graph of one time step: nodes are dynamic bodies, edges join two bodies that share a constraint.
//
// Stored as compressed rows (both directions of an edge are stored): the neighbours of body i are
// neighbour[first[i] .. first[i+1]), ascending. Every edge keeps three weights:
//   pairs        always 1
//   constraints  joints + contact points between the two bodies
//   rows         scalar constraint rows between the two bodies
// Static geometry is no node; constraints with it add to no degree, edge or gain. Bodies may have positions,
// and be in groups that the scene names.
#pragma once

#include <optional>
#include <span>
#include <vector>

namespace cleave {

// The unit in which an edge is weighed (--edge-weight).
enum class EdgeWeight { pairs, constraints, rows };

// One constraint (a joint or one contact point) between bodies a and b; -1 stands for static geometry.
struct ConstraintLink {
  int body_a = -1;
  int body_b = -1;
  int rows = 0;
};

class BodyGraph {
 public:
  BodyGraph() = default;

  // Merges links of the same pair into one edge; links with static geometry or of a body with itself are no
  // edge. mass_kg: (n). Throws std::invalid_argument naming the link when a body index is outside [-1, n) or
  // rows < 1, naming the body when a mass is not finite and positive, and when all rows together exceed a
  // quarter of the range of int (so that no weight, degree, cut or sum of two gains can overflow). step: of
  // the run that the graph was taken from, where there is one. position_m: (n, 3) centres of the bodies, or
  // empty where nobody knows them; throws naming the number that is not finite, and for another size.
  BodyGraph(std::span<const double> mass_kg, std::span<const ConstraintLink> links,
            std::optional<int> step = std::nullopt, std::span<const double> position_m = {});

  std::optional<int> step() const { return step_; }

  int body_count() const { return static_cast<int>(mass_kg_.size()); }
  int edge_count() const { return static_cast<int>(neighbour_.size()) / 2; }
  double mass_kg(int body) const { return mass_kg_[body]; }
  // Constraint rows that are no edge: with static geometry or of the body with itself.
  int fixed_rows(int body) const { return fixed_rows_[body]; }

  bool has_positions() const { return !position_m_.empty(); }
  // axis: 0 to 2. Only where there are positions.
  double position_m(int body, int axis) const {
    return position_m_[3 * static_cast<std::size_t>(body) + axis];
  }

  // group_of_body: (n) numbers, of which equal ones mean one group, -1 none; or empty where no groups are
  // named. Throws std::invalid_argument for another size.
  void set_groups(std::span<const int> group_of_body);
  bool has_groups() const { return !group_.empty(); }
  int group(int body) const { return group_[body]; }  // only where there are groups

  // Degree = number of distinct adjacent bodies.
  int degree(int body) const { return first_[body + 1] - first_[body]; }

  // Half-edges of a body: positions in neighbour() and weight().
  int first(int body) const { return first_[body]; }
  int last(int body) const { return first_[body + 1]; }
  int neighbour(int half_edge) const { return neighbour_[half_edge]; }
  std::span<const int> neighbours(int body) const {
    return std::span(neighbour_).subspan(first_[body], degree(body));
  }
  int weight(int half_edge, EdgeWeight unit) const {
    return unit == EdgeWeight::pairs         ? 1
           : unit == EdgeWeight::constraints ? constraints_[half_edge]
                                             : rows_[half_edge];
  }

  // The graphs of disjoint sets of bodies, each with the edges among its own: body k of graph s is the k-th
  // body in ascending order of those whose set is s. set_of_body: (n) 0..sets-1, or -1 for bodies in none.
  std::vector<BodyGraph> induced(std::span<const int> set_of_body, int sets) const;

  // The same graph with other numbers for its bodies. number_of_body: (n) 0..n-1, each once.
  BodyGraph renumbered(std::span<const int> number_of_body) const;

 private:
  void add_body(double mass_kg, int fixed_rows);
  // As they are in another graph: a half edge, of the body that is added next, to a body of this one; a body
  // after its half edges.
  void add_half_edge(int neighbour, const BodyGraph& from, int half_edge);
  void add_body(const BodyGraph& from, int body);

  std::vector<double> mass_kg_;   // (n)
  std::vector<int> fixed_rows_;   // (n)
  std::vector<int> first_{0};     // (n + 1)
  std::vector<int> neighbour_;    // (2 edges)
  std::vector<int> constraints_;  // (2 edges)
  std::vector<int> rows_;         // (2 edges)
  std::optional<int> step_;
  std::vector<double> position_m_;  // (n, 3), or empty
  std::vector<int> group_;          // (n), or empty
};

// Connected components: the islands of the step. Returns their number and, if asked, one island id per body,
// numbered by their lowest body.
int count_islands(const BodyGraph& graph, std::vector<int>* island_of_body = nullptr);

// Connected components when only edges inside one part count; as many as there are parts when every part is
// connected. part_of_body: (n), any ids.
int count_pieces(const BodyGraph& graph, std::span<const int> part_of_body);

}  // namespace cleave
