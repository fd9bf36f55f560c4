#include "harness/splitter.h"

#include <stdexcept>

#include "harness/problem_graph.h"
#include "harness/stopwatch.h"
#include "partition/registry.h"

namespace cleave {
namespace {

template <class Entry>
auto make_by_name(std::span<const Entry> table, std::string_view name) {
  for (const Entry& entry : table)
    if (entry.name == name) return entry.make();
  throw std::invalid_argument(std::string(name));
}

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

Partition partition_large_islands(const BodyGraph& graph, const Partitioner& partitioner,
                                  const PartitionOptions& options) {
  const int bodies = graph.body_count();
  std::vector<int> island_of_body;
  std::vector<int> island_size(count_islands(graph, &island_of_body), 0);
  for (const int island : island_of_body) ++island_size[island];

  std::vector<int> body_of, index_of(bodies, -1);
  for (int body = 0; body < bodies; ++body) {
    if (island_size[island_of_body[body]] <= options.max_bodies) continue;
    index_of[body] = static_cast<int>(body_of.size());
    body_of.push_back(body);
  }
  const Partition large = partitioner.run(induced_graph(graph, body_of, index_of), options);

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

Splitter::Splitter(std::string_view partitioner, std::string_view refiner, const RunOptions& options)
    : partitioner_(make_by_name(partitioners(), partitioner)),
      refiner_(make_by_name(refiners(), refiner)),
      partition_options_(options.partition),
      refine_options_(options.refine()),
      skip_small_islands_(options.skip_small_islands) {}

Partition Splitter::grow(const BodyGraph& graph) const {
  return skip_small_islands_ ? partition_large_islands(graph, *partitioner_, partition_options_)
                             : partitioner_->run(graph, partition_options_);
}

Split Splitter::run(const StepProblem& problem) const {
  Split split;
  Stopwatch watch;
  split.graph = body_graph_of(problem);
  split.graph_ms = watch.lap_ms();
  split.before = grow(split.graph);
  split.partition_ms = watch.lap_ms();
  split.parts = split.before;
  watch.lap_ms();  // the copy is ours, not the refiner's
  refiner_->run(split.graph, refine_options_, split.parts);
  split.refine_ms = watch.lap_ms();
  return split;
}

}  // namespace cleave
