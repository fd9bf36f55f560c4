// The table of run options: one row an option. Order here is the order of --help and of the manifest.
#include <algorithm>
#include <iterator>

#include "harness/friction.h"
#include "harness/nearest_name.h"
#include "harness/options.h"
#include "harness/options_text.h"
#include "harness/solver_choices.h"
#include "partition/registry.h"

namespace cleave {
namespace {

using Kind = OptionSpec::Kind;
constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr Range kPositive{0, kInfinity, true};
constexpr Range kNonNegative{0, kInfinity};
constexpr Range kAtLeastOne{1, kInfinity};

// The member a row reads and writes: at(&RunOptions::partition, &PartitionOptions::tau_mr).
template <class... Path>
auto at(Path... path) {
  return [=](auto& options) -> auto& { return (options.*....*path); };
}

template <class Member>
OptionSpec number(std::string name, Range range, std::string help, Member member) {
  return {name,
          Kind::number,
          "X",
          help + ", in " + range.text(),
          [=](RunOptions& o, const std::string& text) { member(o) = parse_number(name, text, range); },
          [=](const RunOptions& o) { return number_text(member(o)); }};
}

template <class Member>
OptionSpec integer(std::string name, Range range, std::string help, Member member) {
  return {name,
          Kind::number,
          "N",
          help + ", in " + range.text(),
          [=](RunOptions& o, const std::string& text) { member(o) = parse_integer(name, text, range); },
          [=](const RunOptions& o) { return std::to_string(member(o)); }};
}

template <class Member>
OptionSpec text(std::string name, std::string placeholder, std::string help, Member member) {
  return {name,
          Kind::text,
          placeholder,
          help,
          [=](RunOptions& o, const std::string& value) { member(o) = value; },
          [=](const RunOptions& o) { return member(o); }};
}

template <class Member>
OptionSpec flag(std::string name, std::string help, Member member) {
  return {name,
          Kind::flag,
          "",
          help,
          [=](RunOptions& o, const std::string& value) { member(o) = value == "true"; },
          [=](const RunOptions& o) { return std::string(member(o) ? "true" : "false"); }};
}

// One name of a table.
template <class Member>
OptionSpec name(std::string name, std::vector<std::string> choices, std::string help, Member member) {
  return {name,
          Kind::text,
          "NAME",
          help,
          [=](RunOptions& o, const std::string& value) {
            check_name(name, value, choices);
            member(o) = value;
          },
          [=](const RunOptions& o) { return member(o); }};
}

// Several names of a table.
template <class Member>
OptionSpec names(std::string name, std::vector<std::string> choices, bool allow_all, std::string help,
                 Member member) {
  return {name,
          Kind::text,
          allow_all ? "NAMES|all" : "NAMES",
          help,
          [=](RunOptions& o, const std::string& value) {
            member(o) = parse_names(name, value, choices, allow_all);
          },
          [=](const RunOptions& o) { return joined(member(o), ","); }};
}

// One of a few words for the values of an enumeration, in the order of its values.
template <class Member>
OptionSpec word(std::string name, std::vector<std::string> words, std::string help, Member member) {
  return {name,
          Kind::text,
          joined(words, "|"),
          help,
          [=](RunOptions& o, const std::string& value) {
            check_name(name, value, words);
            using Enum = std::remove_reference_t<decltype(member(o))>;
            member(o) = static_cast<Enum>(std::ranges::find(words, value) - words.begin());
          },
          [=](const RunOptions& o) { return words[static_cast<std::size_t>(member(o))]; }};
}

std::vector<OptionSpec> experiment_options() {
  return {
      text("scene", "NAME", "scene to simulate (cleave list scenes)", at(&RunOptions::scene)),
      names("partitioner", names_of(partitioners()), true, "partitioners to compare",
            at(&RunOptions::partitioners)),
      names("refiner", names_of(refiners()), true, "refiners to compare", at(&RunOptions::refiners)),
      names("solver", solver_choices(), false,
            "solvers to compare; one that ignores parts runs once per step", at(&RunOptions::solvers)),
      text("strategy", "NAME", "strategy in place of that of every --solver", at(&RunOptions::strategy)),
      text("kernel", "NAME", "kernel in place of that of every --solver", at(&RunOptions::kernel)),
      integer("sweeps", kNonNegative, "Gauss-Seidel sweeps of pgs", at(&RunOptions::sweeps)),
      integer("predictor-sweeps", kNonNegative, "Gauss-Seidel sweeps that the strategy pivot starts from",
              at(&RunOptions::predictor_sweeps)),
      integer("max-iterations", kAtLeastOne, "iterations after which a strategy gives up",
              at(&RunOptions::max_iterations)),
      integer("quickstep-iterations", kAtLeastOne, "iterations of ode-quickstep",
              at(&RunOptions::ode_baseline, &OdeBaselineOptions::quickstep_iterations)),
      integer("ode-step-max-rows", kNonNegative, "ode-step refuses a step of more rows: its time explodes",
              at(&RunOptions::ode_baseline, &OdeBaselineOptions::step_max_rows)),
      word("ode-friction", {"limits", "pyramid"},
           "of ODE's own solvers. limits: the problem's bounds as force limits; pyramid: bounds that ODE "
           "finds",
           at(&RunOptions::ode_baseline, &OdeBaselineOptions::friction)),
      name("advance", solver_choices(), "solver that advances the world in lockstep",
           at(&RunOptions::advance)),
      word("mode", {"lockstep", "separate"},
           "lockstep: all combinations solve the same problems; separate: one world per combination",
           at(&RunOptions::mode)),
      integer("steps", kNonNegative, "steps to simulate", at(&RunOptions::steps)),
      integer("measure-every", kAtLeastOne, "measure the last of every N steps",
              at(&RunOptions::measure_every)),
      integer("skip", kNonNegative, "first steps that reports leave out; recorded only",
              at(&RunOptions::skip)),
      integer("repeats", kAtLeastOne, "solves of every measured cell from the same warm start",
              at(&RunOptions::repeats)),
      integer("threads", {1, 1024}, "threads of a solve", at(&RunOptions::threads)),
      {"seed", Kind::number, "N", "seed of the scene's random choices, in [0, 2^64)",
       [](RunOptions& o, const std::string& value) { o.seed = parse_seed("seed", value); },
       [](const RunOptions& o) { return std::to_string(o.seed); }},
      text("out", "DIR", "directory for steps.csv and manifest.json", at(&RunOptions::out)),
      flag("force", "overwrite the steps.csv that --out holds", at(&RunOptions::force)),
      flag("record-motion",
           "write bodies, graph and parts of every step to motion.h5, for pictures and the viewer",
           at(&RunOptions::record_motion)),
      flag("reuse-analysis",
           "keep a solver's symbolic analysis while parts stay and contacts fit its pattern",
           at(&RunOptions::reuse_analysis)),
  };
}

std::vector<OptionSpec> physics_options() {
  return {
      number("dt", kPositive, "step h, s", at(&RunOptions::extract, &ExtractOptions::h_s)),
      number("mu", kNonNegative, "friction coefficient", at(&RunOptions::extract, &ExtractOptions::mu)),
      number("cfm", kNonNegative, "constraint force mixing; compliance C = cfm / h",
             at(&RunOptions::extract, &ExtractOptions::cfm)),
      number("erp", {0, 1}, "error reduction: share of a position error removed per step",
             at(&RunOptions::extract, &ExtractOptions::erp)),
      number("stiffness", kPositive, "k in N/m, with --damping: erp = h k / (h k + d), cfm = 1 / (h k + d)",
             at(&RunOptions::stiffness_n_per_m)),
      number("damping", kNonNegative, "d in N s/m, with --stiffness", at(&RunOptions::damping_n_s_per_m)),
      number("gravity", {}, "gravity along -z, m/s^2", at(&RunOptions::gravity_m_per_s2)),
      integer("contact-cap", {1, 65535}, "most contact points of a geom pair", at(&RunOptions::contact_cap)),
      word("friction", names_of(friction_models()), "friction model (cleave list frictions)",
           at(&RunOptions::extract, &ExtractOptions::friction)),
      number("friction-force-n", kNonNegative,
             "largest friction force along a tangent with --friction constant, N",
             at(&RunOptions::extract, &ExtractOptions::friction_force_n)),
      number("match-tolerance", kNonNegative,
             "a contact continues one of the previous step within this share of the smaller shape's least "
             "extent",
             at(&RunOptions::match_tolerance)),
  };
}

std::vector<OptionSpec> partition_options() {
  return {
      integer("max-bodies", kAtLeastOne, "n_max: most bodies of a part while growing",
              at(&RunOptions::partition, &PartitionOptions::max_bodies)),
      number("tau-mr", {1, kInfinity, true}, "mr joins bodies of mass ratio below this",
             at(&RunOptions::partition, &PartitionOptions::tau_mr)),
      number("tau-mix", {0, 1}, "mix grows this share of a part by least degree",
             at(&RunOptions::partition, &PartitionOptions::tau_mix)),
      number("max-growth", kNonNegative, "fm lets a part grow to (1 + this) max-bodies",
             at(&RunOptions::max_growth)),
      word("edge-weight", {"pairs", "constraints", "rows"}, "unit of edge weights in mix, kl and fm",
           at(&RunOptions::partition, &PartitionOptions::edge_weight)),
      word("degree", {"bodies", "constraints"}, "what the degree of a body counts",
           at(&RunOptions::partition, &PartitionOptions::degree)),
      word("degree-scope", {"whole", "left"},
           "count degrees in the whole graph or among bodies not yet in a part",
           at(&RunOptions::partition, &PartitionOptions::degree_scope)),
      flag("as-printed",
           "the paper to the letter: pairs in kl and fm, constraints in mix and maxdp, no bound on a part in "
           "fm",
           at(&RunOptions::partition, &PartitionOptions::as_printed)),
      flag("skip-small-islands", "make every island of at most max-bodies bodies one part",
           at(&RunOptions::skip_small_islands)),
  };
}

std::vector<OptionSpec> all_options() {
  std::vector<OptionSpec> all = experiment_options();
  std::ranges::move(physics_options(), std::back_inserter(all));
  std::ranges::move(partition_options(), std::back_inserter(all));
  return all;
}

}  // namespace

std::span<const OptionSpec> run_option_specs() {
  static const std::vector<OptionSpec> specs = all_options();
  return specs;
}

}  // namespace cleave
