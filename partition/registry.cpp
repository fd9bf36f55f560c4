#include "partition/registry.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "harness/base/names.h"
#include "partition/merge_small.h"
#include "partition/parameters.h"

namespace cleave {

std::unique_ptr<Partitioner> make_mindp(const Settings& settings);
std::unique_ptr<Partitioner> make_maxdp(const Settings& settings);
std::unique_ptr<Partitioner> make_bfs(const Settings& settings);
PartsPromise bfs_promise_with(const PartsPromise& promise, const Settings& settings);
std::unique_ptr<Partitioner> make_mass_ratio(const Settings& settings);
std::unique_ptr<Partitioner> make_mix(const Settings& settings);
std::unique_ptr<Partitioner> make_multilevel(const Settings& settings);
std::unique_ptr<Partitioner> make_multilevel_cost(const Settings& settings);
std::unique_ptr<Partitioner> make_single(const Settings& settings);
std::unique_ptr<Partitioner> make_random(const Settings& settings);
std::unique_ptr<Partitioner> make_semantic(const Settings& settings);
std::unique_ptr<Partitioner> make_geometric(const Settings& settings);
std::unique_ptr<Partitioner> make_karger(const Settings& settings);
std::unique_ptr<Partitioner> make_karger_cost(const Settings& settings);
std::unique_ptr<Partitioner> make_auto(const Settings& settings);
std::unique_ptr<Partitioner> make_file(const Settings& settings);
std::string file_content(const Settings& settings);

// The adapter of a library is compiled where the library was found (CMakeLists.txt).
#ifdef CLEAVE_METIS
std::unique_ptr<Partitioner> make_metis_recursive(const Settings& settings);
std::unique_ptr<Partitioner> make_metis_kway(const Settings& settings);
constexpr const char* kMetisUnavailable = "";
#else
constexpr std::unique_ptr<Partitioner> (*make_metis_recursive)(const Settings&) = nullptr;
constexpr std::unique_ptr<Partitioner> (*make_metis_kway)(const Settings&) = nullptr;
constexpr const char* kMetisUnavailable = "install libmetis-dev and build again";
#endif
#ifdef CLEAVE_SCOTCH
std::unique_ptr<Partitioner> make_scotch(const Settings& settings);
constexpr const char* kScotchUnavailable = "";
#else
constexpr std::unique_ptr<Partitioner> (*make_scotch)(const Settings&) = nullptr;
constexpr const char* kScotchUnavailable = "install libscotch-dev and build again";
#endif

std::unique_ptr<Refiner> make_none(const Settings& settings);
std::unique_ptr<Refiner> make_kernighan_lin(const Settings& settings);
std::unique_ptr<Refiner> make_fiduccia_mattheyses(const Settings& settings);
std::unique_ptr<Refiner> make_kl_hill(const Settings& settings);
std::unique_ptr<Refiner> make_fm_hill(const Settings& settings);
std::unique_ptr<Refiner> make_fm_cost(const Settings& settings);

namespace {

using namespace parameters;

constexpr const char* kGrowing = "Liu & Andrews 2022, section 3.1";
constexpr const char* kRefining = "Liu & Andrews 2022, section 3.2";
constexpr const char* kOfMetis = "Karypis & Kumar 1998";
constexpr PartsPromise kGrown{.contiguous = true, .at_most_max_bodies = true, .grown_in_order = true};
// mr closes a part where masses differ too much.
constexpr PartsPromise kClosedEarly{.contiguous = true, .at_most_max_bodies = true};

// The row of that name. option: what an error begins with.
template <class Entry>
const Entry& checked_row(std::span<const Entry> table, const std::string& option, const std::string& name) {
  check_name(option, name, names_of(table));
  return *find_row(table, name);
}

// Which other row of the table has a parameter.
template <class Entry>
ParameterOwners owners_in(std::span<const Entry> table) {
  return [table](const std::string& parameter) {
    std::vector<std::string> owners;
    for (const Entry& entry : table)
      if (has_parameter(entry, parameter)) owners.push_back(entry.name);
    return joined(owners);
  };
}

template <class Entry>
Algorithm read_row(std::span<const Entry> table, const std::string& option, const std::string& text) {
  const Entry& entry = checked_row(table, option, algorithm_name(text));
  return read_algorithm(option, text, entry.parameters, {}, owners_in(table));
}

}  // namespace

std::span<const PartitionerEntry> partitioners() {
  static const PartitionerEntry table[] = {
      {{"mindp",
        "grow by the body of least degree",
        kGrowing,
        {max_bodies(), degree(), degree_scope(), merge_small()}},
       kGrown,
       make_mindp,
       {.of_paper = true}},
      {{"maxdp",
        "grow by the body of greatest degree",
        kGrowing,
        {max_bodies(), degree(), degree_scope(), as_printed(), merge_small()}},
       kGrown,
       make_maxdp,
       {.of_paper = true}},
      {{"bfs",
        "grow breadth first",
        kGrowing,
        {max_bodies(),
         {.name = "restart",
          .kind = Parameter::Kind::word,
          .default_value = "part",
          .words = {"part", "graph"},
          .help = "search anew for each part, or chop one order of the whole graph",
          .source = "partition/README.md"},
         merge_small()}},
       kGrown,
       make_bfs,
       {.of_paper = true, .promise_with = bfs_promise_with}},
      {{"mr",
        "grow by bodies whose mass ratio stays below tau-mr",
        kGrowing,
        {max_bodies(), tau_mr(), merge_small()}},
       kClosedEarly,
       make_mass_ratio,
       {.of_paper = true}},
      {{"mix",
        "grow by least degree, then by greatest edge weight into the part",
        "Liu & Andrews 2022, Algorithm 1",
        {max_bodies(), tau_mix(), edge_weight(), degree(), degree_scope(), as_printed(), merge_small()}},
       kGrown,
       make_mix,
       {.of_paper = true}},
      {{"multilevel",
        "multilevel bisection by recursion",
        "Karypis & Kumar 1998",
        {max_bodies(), max_growth(), edge_weight(), partition_seed(), effort()}},
       {.at_most_grown_bodies = true},
       make_multilevel},
      {{"multilevel-cost",
        "multilevel with several seeds, of which the least modelled time counts",
        "partition/README.md",
        {max_bodies(),
         max_growth(),
         edge_weight(),
         partition_seed(),
         {.name = "seeds",
          .kind = Parameter::Kind::integer,
          .default_value = "10",
          .range = {1, 10000},
          .help = "from partition-seed on, of which the least modelled time counts",
          .source = "partition/README.md"},
         effort(),
         calibration(),
         cost_kernel(),
         cost_threads()}},
       {.at_most_grown_bodies = true},
       make_multilevel_cost},
      {{"auto",
        "the partitioner, refiner and size of parts of least modelled time, chosen once for graphs of about "
        "a size",
        "partition/README.md",
        {calibration(), cost_kernel(), cost_threads()}},
       {},
       make_auto,
       {.makes_choices = true}},
      {{"file",
        "parts that another program made",
        "METIS 5.1 manual, partition file",
        {{.name = "path",
          .kind = Parameter::Kind::path,
          .help = "text, a part id a line; with {step} or {step:06} in its name one file a step"}},
        file_content},
       {},
       make_file},
      {{"single", "one part with all bodies, as a control", "partition/README.md"}, {}, make_single},
      {{"random",
        "bodies dealt at random into equal parts, as a control",
        "partition/README.md",
        {max_bodies(), partition_seed()}},
       {.at_most_max_bodies = true},
       make_random},
      {{"geometric",
        "halve the longest side of the bounding box of the centres, again and again",
        "Berger & Bokhari 1987",
        {max_bodies()}},
       {.at_most_max_bodies = true},
       make_geometric},
      {{"semantic",
        "the groups of bodies that the scene names",
        "Peiret et al. 2019",
        {max_bodies(),
         {.name = "split",
          .kind = Parameter::Kind::word,
          .default_value = "whole",
          .words = {"whole", "chunks"},
          .help = "one part a group, or groups cut into runs of at most max-bodies bodies",
          .source = "partition/README.md"}}},
       {},
       make_semantic,
       {.needs_groups = true}},
      {{"karger",
        "contract edges at random, best of several trials",
        "Karger 1993; Karger & Stein 1996",
        {max_bodies(), max_growth(), edge_weight(), partition_seed(), trials(), karger_method()}},
       {.contiguous = true, .at_most_grown_bodies = true},
       make_karger},
      {{"karger-cost",
        "karger, of whose trials the least modelled time counts",
        "partition/README.md",
        {max_bodies(), max_growth(), edge_weight(), partition_seed(), trials(), karger_method(),
         calibration(), cost_kernel(), cost_threads()}},
       {.contiguous = true, .at_most_grown_bodies = true},
       make_karger_cost},
      {{"metis-recursive",
        "halve the graph again and again, by METIS",
        kOfMetis,
        {max_bodies(), max_growth(), edge_weight(), partition_seed(), ufactor()},
        nullptr,
        kMetisUnavailable},
       {},
       make_metis_recursive},
      {{"metis-kway",
        "all parts at once, by METIS",
        kOfMetis,
        {max_bodies(), max_growth(), edge_weight(), partition_seed(), ufactor()},
        nullptr,
        kMetisUnavailable},
       {},
       make_metis_kway},
      {{"scotch",
        "all parts at once, by SCOTCH",
        "Pellegrini & Roman 1996",
        {max_bodies(), max_growth(), edge_weight(), partition_seed(), scotch_strategy()},
        nullptr,
        kScotchUnavailable},
       {},
       make_scotch},
  };
  return table;
}

std::span<const RefinerEntry> refiners() {
  static const RefinerEntry table[] = {
      {{"none", "no refinement", kRefining}, make_none, {.of_paper = true}},
      {{"kl",
        "swap bodies of two parts while the cut falls (Kernighan & Lin 1970)",
        kRefining,
        {edge_weight(), as_printed()}},
       make_kernighan_lin,
       {.of_paper = true}},
      {{"fm",
        "move single bodies while the cut falls (Fiduccia & Mattheyses 1982)",
        kRefining,
        {max_growth(), edge_weight(), as_printed()}},
       make_fiduccia_mattheyses,
       {.of_paper = true}},
      {{"kl-hill",
        "swap bodies of two parts in passes that may raise the cut on their way",
        "Kernighan & Lin 1970",
        {edge_weight()}},
       make_kl_hill},
      {{"fm-hill",
        "move single bodies in passes that may raise the cut on their way",
        "Fiduccia & Mattheyses 1982; Sanchis 1989",
        {max_growth(),
         edge_weight(),
         {.name = "patience",
          .kind = Parameter::Kind::integer,
          .default_value = "50",
          .range = {1, std::numeric_limits<double>::infinity()},
          .help = "moves of a pass without a lower cut before it ends",
          .source = "partition/README.md"}}},
       make_fm_hill},
      {{"fm-cost",
        "move single bodies while the modelled time of the solve falls",
        "partition/README.md",
        {max_growth(), edge_weight(), calibration(), cost_kernel(), cost_threads()}},
       make_fm_cost,
       {.may_raise_cut = true}},
  };
  return table;
}

const PartitionerEntry& partitioner_row(const std::string& name) {
  return checked_row(partitioners(), "partitioner", name);
}

std::unique_ptr<Partitioner> make_partitioner(const Algorithm& algorithm) {
  const PartitionerEntry& entry = partitioner_row(algorithm.name);
  check_available("partitioner", entry);
  std::unique_ptr<Partitioner> made = entry.make(algorithm.settings);
  const Settings& settings = algorithm.settings;
  std::optional<int> max_bodies, grown_bodies;
  if (settings.has("max-bodies")) max_bodies = settings.integer("max-bodies");
  if (max_bodies && settings.has("max-growth"))
    grown_bodies = most_grown_bodies(*max_bodies, settings.number("max-growth"));
  const PartsPromise promise =
      entry.traits.promise_with ? entry.traits.promise_with(entry.promise, settings) : entry.promise;
  made->promise(promise, max_bodies, grown_bodies);
  if (!settings.has("merge-small") || !settings.flag("merge-small")) return made;
  made = merge_small(std::move(made), *max_bodies);
  made->promise({.at_most_grown_bodies = true}, max_bodies, most_merged_bodies(*max_bodies));
  return made;
}

std::unique_ptr<Refiner> make_refiner(const Algorithm& algorithm) {
  return checked_row(refiners(), "refiner", algorithm.name).make(algorithm.settings);
}

Algorithm read_partitioner(const std::string& text) { return read_row(partitioners(), "partitioner", text); }
Algorithm read_refiner(const std::string& text) { return read_row(refiners(), "refiner", text); }

std::unique_ptr<Partitioner> make_partitioner(const std::string& text) {
  return make_partitioner(read_partitioner(text));
}

std::unique_ptr<Refiner> make_refiner(const std::string& text) { return make_refiner(read_refiner(text)); }

}  // namespace cleave
