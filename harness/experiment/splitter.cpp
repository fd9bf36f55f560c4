#include "harness/experiment/splitter.h"

#include <algorithm>
#include <iterator>
#include <stdexcept>
#include <string_view>
#include <utility>

#include "harness/base/stopwatch.h"
#include "harness/experiment/algorithms.h"
#include "harness/experiment/small_islands.h"
#include "partition/registry.h"

namespace cleave {
namespace {

// In the order of PartitionOrigin.
constexpr std::string_view kOriginNames[] = {"fresh", "repaired", "kept"};

}  // namespace

std::optional<int> arity_of(const Algorithm& solver) {
  return solver.settings.has("arity") ? std::optional(solver.settings.integer("arity")) : std::nullopt;
}

Splitter::Splitter(const SplitSetup& setup)
    : partitioner_(make_partitioner(setup.partitioner)),
      refiner_(make_refiner(setup.refiner)),
      skip_small_islands_(setup.skip_small_islands),
      order_(setup.order) {
  if (order_.kind != BodyOrder::Kind::scene && content_of("partitioner", setup.partitioner.name) != nullptr)
    throw std::invalid_argument("--body-order: " + order_.text + " renumbers bodies, which the parts of " +
                                setup.partitioner.text + " do not follow; allowed with it: scene");
  if (!setup.choice.empty()) partitioner_->keep_choice(setup.choice);
  if (setup.arity && partitioner_->max_bodies())
    set_splitter_.emplace(setup.partitioner, setup.refiner, *setup.arity);
  if (skip_small_islands_ && !partitioner_->max_bodies())
    throw std::invalid_argument("--skip-small-islands: partitioner " + setup.partitioner.text +
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

void Splitter::run_once(Split& split) const {
  Stopwatch watch;
  split.before = grow(split.graph);
  split.partition_ms = watch.lap_ms();
  split.parts = split.before;
  const int max_bodies = most_bodies(split.before);
  watch.lap_ms();  // the copy is ours, not the refiner's
  refiner_->run(split.graph, max_bodies, split.parts);
  split.refine_ms = watch.lap_ms();
}

// refine_ms: grows by what was spent in the refiner.
Partition Splitter::nest(const BodyGraph& graph, bool refines, double& refine_ms) const {
  const auto split_set = [&](const BodyGraph& set, int most_bodies) {
    Partition parts = set_splitter_->grow(set, most_bodies);
    Stopwatch watch;
    if (refines) set_splitter_->refine(set, most_bodies, parts);
    refine_ms += watch.lap_ms();
    return parts;
  };
  const int max_bodies = set_splitter_->max_bodies(), arity = set_splitter_->arity();
  if (!skip_small_islands_) return split_by_recursion(graph, max_bodies, arity, split_set);
  const SmallIslands islands(graph, max_bodies);
  return islands.with_small_in_tree(split_by_recursion(islands.large(), max_bodies, arity, split_set));
}

void Splitter::run_recursion(Split& split) const {
  Stopwatch watch;
  split.parts = nest(split.graph, true, split.refine_ms);
  split.partition_ms = watch.lap_ms() - split.refine_ms;
  double untimed_ms = 0;
  split.before = nest(split.graph, false, untimed_ms);
}

Split Splitter::run(const StepProblem& problem, std::optional<int> step, const KnownBodies& known) const {
  Split split;
  Stopwatch watch;
  split.graph = body_graph_of(problem, step, known);
  split.graph_ms = watch.lap_ms();
  run(split);
  return split;
}

void Splitter::run(Split& split) const {
  if (order_.kind == BodyOrder::Kind::scene) return run_by_numbers(split);
  const std::vector<int> number = order_.numbers(split.graph.body_count(), split.graph.step());
  const BodyGraph graph = std::exchange(split.graph, split.graph.renumbered(number));
  run_by_numbers(split);
  split.graph = graph;
  for (Partition* partition : {&split.before, &split.parts}) {
    const std::vector<int> part_of_number = partition->part_of_body;
    for (std::size_t body = 0; body < number.size(); ++body)
      partition->part_of_body[body] = part_of_number[number[body]];
  }
}

void Splitter::run_by_numbers(Split& split) const {
  if (set_splitter_) {
    run_recursion(split);
  } else {
    run_once(split);
  }
}

std::string to_string(PartitionOrigin origin) {
  return std::string(kOriginNames[static_cast<std::size_t>(origin)]);
}

std::optional<PartitionOrigin> find_origin(const std::string& text) {
  const auto found = std::ranges::find(kOriginNames, text);
  if (found == std::end(kOriginNames)) return std::nullopt;
  return static_cast<PartitionOrigin>(found - std::begin(kOriginNames));
}

}  // namespace cleave
