#include "harness/commands/stored_partition.h"

#include <algorithm>
#include <limits>
#include <stdexcept>

#include "harness/base/numbers.h"
#include "harness/experiment/algorithms.h"

namespace cleave {
namespace {

constexpr const char* kSkipSmallIslands = "skip_small_islands";
constexpr const char* kArity = "arity";
constexpr const char* kOrigin = "partition_origin";
constexpr const char* kChoice = "auto_choice";
constexpr const char* kBodyOrder = "body_order";
constexpr const char* kOfRefiner = "refiner_";
constexpr Range kArities{2, std::numeric_limits<double>::infinity()};

void add_parameters(const std::string& option, const Algorithm& algorithm, const std::string& prefix,
                    std::vector<StoredParameter>& to) {
  for (const Parameter& parameter : parameters_of(option, algorithm.name)) {
    if (parameter.kind == Parameter::Kind::path) continue;
    const StoredParameter plain{column_of(parameter.name), parameter.kind,
                                algorithm.settings.text(parameter.name)};
    if (std::ranges::count(to, plain) > 0) continue;
    const bool taken = std::ranges::count(to, plain.name, &StoredParameter::name) > 0;
    to.push_back({(taken ? prefix : "") + plain.name, plain.kind, plain.text});
  }
}

const StoredParameter* find_stored(const StoredPartition& partition, const std::string& name) {
  const auto found = std::ranges::find(partition.parameters, name, &StoredParameter::name);
  return found == partition.parameters.end() ? nullptr : &*found;
}

// The stored values of an algorithm's parameters, by parameter name.
CommonValues stored_values(const StoredPartition& partition, const std::string& option,
                           const std::string& name, const std::string& prefix) {
  CommonValues values;
  for (const Parameter& parameter : parameters_of(option, name)) {
    if (parameter.kind == Parameter::Kind::path) continue;
    const std::string column = column_of(parameter.name);
    const StoredParameter* own = find_stored(partition, prefix + column);
    const StoredParameter* stored = own != nullptr ? own : find_stored(partition, column);
    if (stored == nullptr)
      throw std::invalid_argument(column + " is missing, which " + option + " " + name + " has");
    values[parameter.name] = stored->text;
  }
  return values;
}

Algorithm read_stored(const StoredPartition& partition, const std::string& option, const std::string& text,
                      const std::string& prefix) {
  check_algorithm(option, text);
  return read_named(option, text, stored_values(partition, option, algorithm_name(text), prefix));
}

}  // namespace

StoredPartition stored_partition(const SplitSetup& setup, std::vector<int> part_of_body,
                                 std::vector<int> parent_of_part, PartitionOrigin origin) {
  StoredPartition stored{
      setup.partitioner.text, setup.refiner.text, {}, std::move(part_of_body), std::move(parent_of_part)};
  add_parameters("partitioner", setup.partitioner, "", stored.parameters);
  add_parameters("refiner", setup.refiner, kOfRefiner, stored.parameters);
  stored.parameters.push_back(
      {kSkipSmallIslands, Parameter::Kind::flag, setup.skip_small_islands ? "true" : "false"});
  if (setup.arity)
    stored.parameters.push_back({kArity, Parameter::Kind::integer, std::to_string(*setup.arity)});
  if (origin != PartitionOrigin::fresh)
    stored.parameters.push_back({kOrigin, Parameter::Kind::word, to_string(origin)});
  if (setup.order.kind != BodyOrder::Kind::scene)
    stored.parameters.push_back({kBodyOrder, Parameter::Kind::word, setup.order.text});
  if (!setup.choice.empty()) stored.parameters.push_back({kChoice, Parameter::Kind::word, setup.choice});
  return stored;
}

PartitionOrigin read_origin(const StoredPartition& partition) {
  const StoredParameter* stored = find_stored(partition, kOrigin);
  if (stored == nullptr) return PartitionOrigin::fresh;
  const std::optional<PartitionOrigin> origin = find_origin(stored->text);
  if (!origin)
    throw std::invalid_argument(std::string(kOrigin) + " = " + stored->text +
                                ", allowed: fresh, repaired, kept");
  return *origin;
}

std::string read_choice(const StoredPartition& partition) {
  const StoredParameter* choice = find_stored(partition, kChoice);
  return choice == nullptr ? "" : choice->text;
}

Algorithm read_stored_refiner(const StoredPartition& partition) {
  return read_stored(partition, "refiner", partition.refiner, kOfRefiner);
}

bool has_order_of_file(const StoredPartition& partition) {
  const StoredParameter* stored = find_stored(partition, kBodyOrder);
  return stored != nullptr && stored->text.starts_with("file@");
}

SplitSetup read_split_setup(const StoredPartition& partition) {
  SplitSetup setup{read_stored(partition, "partitioner", partition.partitioner, ""),
                   read_stored_refiner(partition)};
  const StoredParameter* skip = find_stored(partition, kSkipSmallIslands);
  setup.skip_small_islands = skip != nullptr && skip->text == "true";
  if (has_order_of_file(partition)) throw std::invalid_argument("the file of its body order is not here");
  if (const StoredParameter* order = find_stored(partition, kBodyOrder))
    setup.order = read_body_order(kBodyOrder, order->text);
  setup.choice = read_choice(partition);
  if (const StoredParameter* arity = find_stored(partition, kArity))
    setup.arity = parse_integer("--arity", arity->text, kArities);
  else if (!partition.parent_of_part.empty() && setup.choice.empty())
    throw std::invalid_argument("arity is missing, which parts in a tree have");
  return setup;
}

}  // namespace cleave
