#include "tests/partition/paper_options.h"

#include <algorithm>
#include <map>
#include <string>

#include "harness/base/numbers.h"

namespace cleave::partition_test {
namespace {

using Values = std::map<std::string, std::string>;

std::string word(const Parameter& parameter, int index) { return parameter.words.at(index); }
std::string flag(bool value) { return value ? "true" : "false"; }

Algorithm complete(const AlgorithmEntry& entry, const Values& values) {
  const auto nobody = [](const std::string&) { return std::string(); };
  return read_algorithm("test", entry.name, entry.parameters, values, nobody);
}

}  // namespace

Algorithm algorithm_of(const AlgorithmEntry& entry, const PartitionOptions& options) {
  return complete(entry,
                  {{"max-bodies", std::to_string(options.max_bodies)},
                   {"tau-mr", number_text(options.tau_mr)},
                   {"tau-mix", number_text(options.tau_mix)},
                   {"edge-weight", word(parameters::edge_weight(), static_cast<int>(options.edge_weight))},
                   {"trials", std::to_string(options.trials)},
                   {"degree", word(parameters::degree(), static_cast<int>(options.degree))},
                   {"degree-scope", word(parameters::degree_scope(), static_cast<int>(options.degree_scope))},
                   {"as-printed", flag(options.as_printed)}});
}

Algorithm algorithm_of(const AlgorithmEntry& entry, const RefineOptions& options) {
  return complete(entry,
                  {{"max-growth", number_text(options.max_growth)},
                   {"edge-weight", word(parameters::edge_weight(), static_cast<int>(options.edge_weight))},
                   {"as-printed", flag(options.as_printed)}});
}

RefineOptions options_of(const AlgorithmEntry& entry, const RefineOptions& options) {
  const auto has = [&](const std::string& name) {
    return std::ranges::count(entry.parameters, name, &Parameter::name) > 0;
  };
  if (!has("edge-weight")) return RefineOptions{.max_bodies = options.max_bodies};
  RefineOptions seen = options;
  seen.as_printed = options.as_printed && has("as-printed");
  return seen;
}

Partition run(const PartitionerEntry& entry, const BodyGraph& graph, const PartitionOptions& options) {
  return make_partitioner(algorithm_of(entry, options))->run(graph);
}

RefineSummary run(const RefinerEntry& entry, const BodyGraph& graph, const RefineOptions& options,
                  Partition& partition) {
  return make_refiner(algorithm_of(entry, options))->run(graph, options.max_bodies, partition);
}

}  // namespace cleave::partition_test
