#include "partition/registry.h"

#include <algorithm>
#include <stdexcept>

#include "harness/base/names.h"
#include "partition/parameters.h"

namespace cleave {

std::unique_ptr<Partitioner> make_mindp(const Settings& settings);
std::unique_ptr<Partitioner> make_maxdp(const Settings& settings);
std::unique_ptr<Partitioner> make_bfs(const Settings& settings);
std::unique_ptr<Partitioner> make_mass_ratio(const Settings& settings);
std::unique_ptr<Partitioner> make_mix(const Settings& settings);
std::unique_ptr<Partitioner> make_file(const Settings& settings);
std::string file_content(const Settings& settings);

std::unique_ptr<Refiner> make_none(const Settings& settings);
std::unique_ptr<Refiner> make_kernighan_lin(const Settings& settings);
std::unique_ptr<Refiner> make_fiduccia_mattheyses(const Settings& settings);

namespace {

using namespace parameters;

constexpr const char* kGrowing = "Liu & Andrews 2022, section 3.1";
constexpr const char* kRefining = "Liu & Andrews 2022, section 3.2";
constexpr PartsPromise kGrown{.contiguous = true, .at_most_max_bodies = true, .grown_in_order = true};
// mr closes a part where masses differ too much.
constexpr PartsPromise kClosedEarly{.contiguous = true, .at_most_max_bodies = true};

// The row of that name. option: what an error begins with.
template <class Entry>
const Entry& find_row(std::span<const Entry> table, const std::string& option, const std::string& name) {
  check_name(option, name, names_of(table));
  return *std::ranges::find(table, name, [](const Entry& entry) { return std::string(entry.name); });
}

// Which other row of the table has a parameter.
template <class Entry>
ParameterOwners owners_in(std::span<const Entry> table) {
  return [table](const std::string& parameter) {
    std::vector<std::string> owners;
    for (const Entry& entry : table)
      if (std::ranges::count(entry.parameters, parameter, &Parameter::name) > 0) owners.push_back(entry.name);
    return joined(owners);
  };
}

template <class Entry>
Algorithm read_row(std::span<const Entry> table, const std::string& option, const std::string& text) {
  const Entry& entry = find_row(table, option, algorithm_name(text));
  return read_algorithm(option, text, entry.parameters, {}, owners_in(table));
}

}  // namespace

std::span<const PartitionerEntry> partitioners() {
  static const PartitionerEntry table[] = {
      {{"mindp", "grow by the body of least degree", kGrowing, {max_bodies(), degree(), degree_scope()}},
       kGrown,
       true,
       make_mindp},
      {{"maxdp",
        "grow by the body of greatest degree",
        kGrowing,
        {max_bodies(), degree(), degree_scope(), as_printed()}},
       kGrown,
       true,
       make_maxdp},
      {{"bfs", "grow breadth first", kGrowing, {max_bodies()}}, kGrown, true, make_bfs},
      {{"mr", "grow by bodies whose mass ratio stays below tau-mr", kGrowing, {max_bodies(), tau_mr()}},
       kClosedEarly,
       true,
       make_mass_ratio},
      {{"mix",
        "grow by least degree, then by greatest edge weight into the part",
        "Liu & Andrews 2022, Algorithm 1",
        {max_bodies(), tau_mix(), edge_weight(), degree(), degree_scope(), as_printed()}},
       kGrown,
       true,
       make_mix},
      {{"file",
        "parts that another program made",
        "METIS 5.1 manual, partition file",
        {{.name = "path",
          .kind = Parameter::Kind::path,
          .help = "text, a part id a line; with {step} or {step:06} in its name one file a step"}},
        file_content},
       {},
       false,
       make_file},
  };
  return table;
}

std::span<const RefinerEntry> refiners() {
  static const RefinerEntry table[] = {
      {{"none", "no refinement", kRefining}, true, make_none},
      {{"kl",
        "swap bodies of two parts while the cut falls (Kernighan & Lin 1970)",
        kRefining,
        {edge_weight(), as_printed()}},
       true,
       make_kernighan_lin},
      {{"fm",
        "move single bodies while the cut falls (Fiduccia & Mattheyses 1982)",
        kRefining,
        {max_growth(), edge_weight(), as_printed()}},
       true,
       make_fiduccia_mattheyses},
  };
  return table;
}

std::unique_ptr<Partitioner> make_partitioner(const Algorithm& algorithm) {
  const PartitionerEntry& entry = find_row(partitioners(), "partitioner", algorithm.name);
  std::unique_ptr<Partitioner> made = entry.make(algorithm.settings);
  const bool bounded = algorithm.settings.has("max-bodies");
  made->promise(entry.promise,
                bounded ? std::optional(algorithm.settings.integer("max-bodies")) : std::nullopt);
  return made;
}

std::unique_ptr<Refiner> make_refiner(const Algorithm& algorithm) {
  return find_row(refiners(), "refiner", algorithm.name).make(algorithm.settings);
}

std::unique_ptr<Partitioner> make_partitioner(const std::string& text) {
  return make_partitioner(read_row(partitioners(), "partitioner", text));
}

std::unique_ptr<Refiner> make_refiner(const std::string& text) {
  return make_refiner(read_row(refiners(), "refiner", text));
}

}  // namespace cleave
