#include "partition/body_graph.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include "partition/refuse.h"

namespace cleave {
namespace {

// One direction of one link, before links of the same pair are merged.
struct HalfLink {
  int neighbour;
  int rows;
};

void check_masses(std::span<const double> mass_kg) {
  for (size_t i = 0; i < mass_kg.size(); ++i) {
    if (std::isfinite(mass_kg[i]) && mass_kg[i] > 0) continue;
    refuse("mass_kg of body " + std::to_string(i), mass_kg[i], "finite and > 0");
  }
}

void check_links(int bodies, std::span<const ConstraintLink> links) {
  const auto is_body = [&](int body) { return body >= -1 && body < bodies; };
  const std::string body_range = "-1 (static geometry) to " + std::to_string(bodies - 1);
  const int most_rows = std::numeric_limits<int>::max() / 4;  // a gain counts twice, and gains are added
  long total_rows = 0;
  for (size_t k = 0; k < links.size(); ++k) {
    const auto of_link = [&](const char* field) { return field + (" of link " + std::to_string(k)); };
    if (!is_body(links[k].body_a)) refuse(of_link("body_a"), links[k].body_a, body_range);
    if (!is_body(links[k].body_b)) refuse(of_link("body_b"), links[k].body_b, body_range);
    if (links[k].rows < 1) refuse(of_link("rows"), links[k].rows, ">= 1");
    total_rows += links[k].rows;
    if (total_rows > most_rows)
      refuse(of_link("sum of rows to the end"), total_rows, "<= " + std::to_string(most_rows));
  }
}

void check_positions(std::size_t bodies, std::span<const double> position_m) {
  if (position_m.empty()) return;
  if (position_m.size() != 3 * bodies) refuse("size of position_m", position_m.size(), 3 * bodies);
  for (std::size_t k = 0; k < position_m.size(); ++k)
    if (!std::isfinite(position_m[k]))
      refuse("position_m of body " + std::to_string(k / 3), position_m[k], "finite");
}

bool joins_two_bodies(const ConstraintLink& link) {
  return link.body_a >= 0 && link.body_b >= 0 && link.body_a != link.body_b;
}

// Start of every body's half-links, (n + 1).
std::vector<int> row_starts(int bodies, std::span<const ConstraintLink> links) {
  std::vector<int> start(bodies + 1, 0);
  for (const ConstraintLink& link : links) {
    if (!joins_two_bodies(link)) continue;
    ++start[link.body_a + 1];
    ++start[link.body_b + 1];
  }
  for (int i = 0; i < bodies; ++i) start[i + 1] += start[i];
  return start;
}

// The half-links of every body from start[body] on, by neighbour. The list is symmetric, so transposing it
// keeps its rows and sorts every row by neighbour: no comparison sort.
std::vector<HalfLink> half_links(std::span<const ConstraintLink> links, const std::vector<int>& start) {
  const int n = static_cast<int>(start.size()) - 1;
  std::vector<HalfLink> by_body(start[n]), sorted(start[n]);
  std::vector<int> fill(start.begin(), start.end() - 1);
  for (const ConstraintLink& link : links) {
    if (!joins_two_bodies(link)) continue;
    by_body[fill[link.body_a]++] = {link.body_b, link.rows};
    by_body[fill[link.body_b]++] = {link.body_a, link.rows};
  }
  fill.assign(start.begin(), start.end() - 1);
  for (int i = 0; i < n; ++i)
    for (int k = start[i]; k < start[i + 1]; ++k) sorted[fill[by_body[k].neighbour]++] = {i, by_body[k].rows};
  return sorted;
}

// Rows of every body with static geometry, or with itself.
std::vector<int> count_fixed_rows(int bodies, std::span<const ConstraintLink> links) {
  std::vector<int> rows(bodies, 0);
  for (const ConstraintLink& link : links) {
    const int body = std::max(link.body_a, link.body_b);
    if (body >= 0 && !joins_two_bodies(link)) rows[body] += link.rows;
  }
  return rows;
}

}  // namespace

BodyGraph::BodyGraph(std::span<const double> mass_kg, std::span<const ConstraintLink> links,
                     std::optional<int> step, std::span<const double> position_m)
    : mass_kg_(mass_kg.begin(), mass_kg.end()),
      step_(step),
      position_m_(position_m.begin(), position_m.end()) {
  check_masses(mass_kg);
  check_positions(mass_kg.size(), position_m);
  const int n = body_count();
  check_links(n, links);
  fixed_rows_ = count_fixed_rows(n, links);
  const std::vector<int> start = row_starts(n, links);
  const std::vector<HalfLink> half = half_links(links, start);
  first_.assign(1, 0);
  first_.reserve(n + 1);
  for (int i = 0; i < n; ++i) {
    for (int k = start[i]; k < start[i + 1]; ++k) {
      if (k == start[i] || half[k].neighbour != half[k - 1].neighbour) {
        neighbour_.push_back(half[k].neighbour);
        constraints_.push_back(0);
        rows_.push_back(0);
      }
      ++constraints_.back();
      rows_.back() += half[k].rows;
    }
    first_.push_back(static_cast<int>(neighbour_.size()));
  }
}

void BodyGraph::set_groups(std::span<const int> group_of_body) {
  if (!group_of_body.empty() && group_of_body.size() != mass_kg_.size())
    refuse("size of group_of_body", group_of_body.size(), mass_kg_.size());
  group_.assign(group_of_body.begin(), group_of_body.end());
}

void BodyGraph::add_body(double mass_kg, int fixed_rows) {
  mass_kg_.push_back(mass_kg);
  fixed_rows_.push_back(fixed_rows);
  first_.push_back(static_cast<int>(neighbour_.size()));
}

void BodyGraph::add_half_edge(int neighbour, const BodyGraph& from, int half_edge) {
  neighbour_.push_back(neighbour);
  constraints_.push_back(from.constraints_[half_edge]);
  rows_.push_back(from.rows_[half_edge]);
}

void BodyGraph::add_body(const BodyGraph& from, int body) {
  add_body(from.mass_kg_[body], from.fixed_rows_[body]);
  if (from.has_positions())
    for (const int axis : {0, 1, 2}) position_m_.push_back(from.position_m(body, axis));
  if (from.has_groups()) group_.push_back(from.group(body));
}

// Neighbours stay ascending, because bodies keep their order within a set.
std::vector<BodyGraph> BodyGraph::induced(std::span<const int> set_of_body, int sets) const {
  const int n = body_count();
  std::vector<int> bodies(sets, 0), index(n, -1);
  for (int i = 0; i < n; ++i)
    if (set_of_body[i] >= 0) index[i] = bodies[set_of_body[i]]++;
  std::vector<BodyGraph> graphs(sets);
  for (int s = 0; s < sets; ++s) {
    graphs[s].step_ = step_;
    graphs[s].mass_kg_.reserve(bodies[s]);
    graphs[s].first_.reserve(bodies[s] + 1);
  }
  for (int i = 0; i < n; ++i) {
    if (set_of_body[i] < 0) continue;
    BodyGraph& graph = graphs[set_of_body[i]];
    for (int k = first_[i]; k < first_[i + 1]; ++k) {
      if (set_of_body[neighbour_[k]] != set_of_body[i]) continue;
      graph.add_half_edge(index[neighbour_[k]], *this, k);
    }
    graph.add_body(*this, i);
  }
  return graphs;
}

BodyGraph BodyGraph::renumbered(std::span<const int> number_of_body) const {
  const int n = body_count();
  std::vector<int> body_of_number(n);
  for (int i = 0; i < n; ++i) body_of_number[number_of_body[i]] = i;
  BodyGraph graph;
  graph.step_ = step_;
  std::vector<std::pair<int, int>> half_edges;  // neighbour's number, position here
  for (const int body : body_of_number) {
    half_edges.clear();
    for (int k = first_[body]; k < first_[body + 1]; ++k)
      half_edges.emplace_back(number_of_body[neighbour_[k]], k);
    std::ranges::sort(half_edges);
    for (const auto& [neighbour, k] : half_edges) graph.add_half_edge(neighbour, *this, k);
    graph.add_body(*this, body);
  }
  return graph;
}

namespace {

// Flood fill over the edges whose ends carry the same label; pieces are numbered by their lowest body.
template <class SameLabel>
int flood(const BodyGraph& graph, SameLabel same_label, std::vector<int>& piece_of_body) {
  const int n = graph.body_count();
  piece_of_body.assign(n, -1);
  std::vector<int> stack;
  stack.reserve(n);
  int pieces = 0;
  for (int root = 0; root < n; ++root) {
    if (piece_of_body[root] >= 0) continue;
    piece_of_body[root] = pieces;
    stack.push_back(root);
    while (!stack.empty()) {
      const int body = stack.back();
      stack.pop_back();
      for (int other : graph.neighbours(body)) {
        if (piece_of_body[other] >= 0 || !same_label(body, other)) continue;
        piece_of_body[other] = pieces;
        stack.push_back(other);
      }
    }
    ++pieces;
  }
  return pieces;
}

}  // namespace

int count_islands(const BodyGraph& graph, std::vector<int>* island_of_body) {
  std::vector<int> own;
  return flood(
      graph, [](int, int) { return true; }, island_of_body ? *island_of_body : own);
}

int count_pieces(const BodyGraph& graph, std::span<const int> part_of_body) {
  std::vector<int> piece_of_body;
  return flood(
      graph, [&](int a, int b) { return part_of_body[a] == part_of_body[b]; }, piece_of_body);
}

}  // namespace cleave
