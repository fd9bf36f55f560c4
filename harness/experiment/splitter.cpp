#include "harness/experiment/splitter.h"

#include <algorithm>
#include <stdexcept>

#include "harness/base/stopwatch.h"
#include "harness/experiment/problem_graph.h"
#include "partition/registry.h"

namespace cleave {
namespace {

// Edges among the listed bodies, as links that merge to the same weights again. body_of: new index to old.
BodyGraph induced_graph(const BodyGraph& graph, std::span<const int> body_of, std::span<const int> index_of) {
  std::vector<double> mass_kg;
  std::vector<ConstraintLink> links;
  for (const int body : body_of) {
    mass_kg.push_back(graph.mass_kg(body));
    for (int edge = graph.first(body); edge < graph.last(body); ++edge) {
      const int other = graph.neighbour(edge);
      if (other < body) continue;
      const int constraints = graph.weight(edge, EdgeWeight::constraints);
      const int rows = graph.weight(edge, EdgeWeight::rows);
      for (int k = 1; k < constraints; ++k) links.push_back({index_of[body], index_of[other], 1});
      links.push_back({index_of[body], index_of[other], rows - (constraints - 1)});
    }
  }
  return BodyGraph(mass_kg, links);
}

}  // namespace

Partition partition_large_islands(const BodyGraph& graph, const Partitioner& partitioner, int max_bodies) {
  const int bodies = graph.body_count();
  std::vector<int> island_of_body;
  std::vector<int> island_size(count_islands(graph, &island_of_body), 0);
  for (const int island : island_of_body) ++island_size[island];

  std::vector<int> body_of, index_of(bodies, -1);
  for (int body = 0; body < bodies; ++body) {
    if (island_size[island_of_body[body]] <= max_bodies) continue;
    index_of[body] = static_cast<int>(body_of.size());
    body_of.push_back(body);
  }
  const Partition large = partitioner.run(induced_graph(graph, body_of, index_of));

  Partition all{std::vector<int>(bodies, -1), large.part_count};
  std::vector<int> part_of_island(island_size.size(), -1);
  for (int body = 0; body < bodies; ++body) {
    if (index_of[body] >= 0) {
      all.part_of_body[body] = large.part_of_body[index_of[body]];
      continue;
    }
    int& part = part_of_island[island_of_body[body]];
    if (part < 0) part = all.part_count++;
    all.part_of_body[body] = part;
  }
  return all;
}

Splitter::Splitter(const Algorithm& partitioner, const Algorithm& refiner, bool skip_small_islands)
    : partitioner_(make_partitioner(partitioner)),
      refiner_(make_refiner(refiner)),
      skip_small_islands_(skip_small_islands) {
  if (skip_small_islands && !partitioner_->max_bodies())
    throw std::invalid_argument("--skip-small-islands: partitioner " + partitioner.text +
                                " has no max-bodies, which says what is small");
}

Partition Splitter::grow(const BodyGraph& graph) const {
  return skip_small_islands_ ? partition_large_islands(graph, *partitioner_, *partitioner_->max_bodies())
                             : partitioner_->run(graph);
}

// Parts without a bound of their own may grow from the size of the largest.
int Splitter::most_bodies(const Partition& grown) const {
  if (partitioner_->max_bodies()) return *partitioner_->max_bodies();
  int largest = 1;
  for (const int bodies : part_sizes(grown)) largest = std::max(largest, bodies);
  return largest;
}

Split Splitter::run(const StepProblem& problem, std::optional<int> step) const {
  Split split;
  Stopwatch watch;
  split.graph = body_graph_of(problem, step);
  split.graph_ms = watch.lap_ms();
  split.before = grow(split.graph);
  split.partition_ms = watch.lap_ms();
  split.parts = split.before;
  const int max_bodies = most_bodies(split.before);
  watch.lap_ms();  // the copy is ours, not the refiner's
  refiner_->run(split.graph, max_bodies, split.parts);
  split.refine_ms = watch.lap_ms();
  return split;
}

}  // namespace cleave
