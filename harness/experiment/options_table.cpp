// The table of run options: one row an option. Order here is the order of --help and of the manifest.
// Parameters of algorithms and scenes are not in here: their rows declare them.
#include <algorithm>
#include <iterator>

#include "harness/base/names.h"
#include "harness/experiment/friction.h"
#include "harness/experiment/options.h"

namespace cleave {
namespace {

using Kind = OptionKind;
constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr Range kPositive{0, kInfinity, true};
constexpr Range kNonNegative{0, kInfinity};
constexpr Range kAtLeastOne{1, kInfinity};

constexpr CommandSet kEverywhere{true, true, true};
constexpr CommandSet kWithWorld{true, true, false};
constexpr CommandSet kRunAndReplay{true, false, true};
constexpr CommandSet kRunOnly{true, false, false};

// What a row of the table begins with.
struct Row {
  const char* name;
  About about;
  CommandSet commands;
  bool in_run_id = true;
};
constexpr bool kChangesNoRow = false;

// The member a row reads and writes: at(&RunOptions::extract, &ExtractOptions::h_s).
template <class... Path>
auto at(Path... path) {
  return [=](auto& options) -> auto& { return (options.*....*path); };
}

OptionSpec spec(const Row& row, Kind kind, std::string placeholder, std::string help,
                std::function<void(RunOptions&, const std::string&)> set,
                std::function<std::string(const RunOptions&)> get) {
  return {row.name,     kind,          std::move(placeholder), std::move(help), row.about,
          row.commands, row.in_run_id, std::move(set),         std::move(get)};
}

template <class Member>
OptionSpec number(const Row& row, Range range, std::string help, Member member) {
  return spec(
      row, Kind::number, "X", help + ", in " + range.text(),
      [=, option = std::string("--") + row.name](RunOptions& o, const std::string& text) {
        member(o) = parse_number(option, text, range);
      },
      [=](const RunOptions& o) { return number_text(member(o)); });
}

template <class Member>
OptionSpec integer(const Row& row, Range range, std::string help, Member member) {
  return spec(
      row, Kind::number, "N", help + ", in " + range.text(),
      [=, option = std::string("--") + row.name](RunOptions& o, const std::string& text) {
        member(o) = parse_integer(option, text, range);
      },
      [=](const RunOptions& o) { return std::to_string(member(o)); });
}

template <class Member>
OptionSpec text(const Row& row, std::string placeholder, std::string help, Member member) {
  return spec(
      row, Kind::text, std::move(placeholder), std::move(help),
      [=](RunOptions& o, const std::string& value) { member(o) = value; },
      [=](const RunOptions& o) { return member(o); });
}

template <class Member>
OptionSpec flag(const Row& row, std::string help, Member member) {
  return spec(
      row, Kind::flag, "", std::move(help),
      [=, option = std::string("--") + row.name](RunOptions& o, const std::string& value) {
        check_name(option, value, std::vector<std::string>{"true", "false"});
        member(o) = value == "true";
      },
      [=](const RunOptions& o) { return std::string(member(o) ? "true" : "false"); });
}

// One algorithm of a registry, with the parameters that were given for all.
template <class Member>
OptionSpec algorithm(const Row& row, std::string help, Member member) {
  return spec(
      row, Kind::text, "NAME", std::move(help),
      [=, name = std::string(row.name)](RunOptions& o, const std::string& value) {
        member(o) = read_named(name, value, o.common);
      },
      [=](const RunOptions& o) { return member(o).text; });
}

template <class Member>
OptionSpec algorithms(const Row& row, std::string placeholder, std::string help, Member member) {
  return spec(
      row, Kind::text, std::move(placeholder), std::move(help),
      [=, name = std::string(row.name)](RunOptions& o, const std::string& value) {
        member(o) = read_list(name, value, o.common, &o.notes);
      },
      [=](const RunOptions& o) {
        std::vector<std::string> texts;
        for (const Algorithm& algorithm : member(o)) texts.push_back(algorithm.text);
        return joined(texts, ",");
      });
}

// One of a few words for the values of an enumeration, in the order of its values.
template <class Member>
OptionSpec word(const Row& row, std::vector<std::string> words, std::string help, Member member) {
  return spec(
      row, Kind::text, joined(words, "|"), std::move(help),
      [=, option = std::string("--") + row.name](RunOptions& o, const std::string& value) {
        check_name(option, value, words);
        using Enum = std::remove_reference_t<decltype(member(o))>;
        member(o) = static_cast<Enum>(std::ranges::find(words, value) - words.begin());
      },
      [=](const RunOptions& o) { return words.at(static_cast<std::size_t>(member(o))); });
}

OptionSpec repartition() {
  return spec(
      {"repartition", About::partition, kRunAndReplay}, Kind::text, "always|on-change|every:K|drift:X",
      "new parts in every step, or those of the step before, repaired where bodies or adjacent pairs "
      "changed: throughout, with "
      "new ones every K steps, or until the share of rows that is cut exceeds (1 + X) times that of the last "
      "new ones; with "
      "and without --session",
      [](RunOptions& o, const std::string& value) {
        o.repartition = read_repartition("--repartition", value);
      },
      [](const RunOptions& o) { return o.repartition.text; });
}

OptionSpec body_order() {
  return spec(
      {"body-order", About::partition, kRunAndReplay}, Kind::text, "scene|random[@seed=N]|file@PATH",
      "numbers by which bodies are split: as the scene creates them, shuffled, or on the lines of a file",
      [](RunOptions& o, const std::string& value) { o.body_order = read_body_order("--body-order", value); },
      [](const RunOptions& o) { return o.body_order.text; });
}

OptionSpec seed() {
  return spec(
      {"seed", About::bookkeeping, kWithWorld}, Kind::number, "N",
      "seed of the scene's random choices, in [0, 2^64)",
      [](RunOptions& o, const std::string& value) { o.seed = parse_seed("--seed", value); },
      [](const RunOptions& o) { return std::to_string(o.seed); });
}

std::vector<OptionSpec> experiment_options() {
  constexpr About kAbout = About::bookkeeping;
  return {
      algorithm({"scene", kAbout, kWithWorld}, "scene to simulate (cleave list scenes)",
                at(&RunOptions::scene)),
      algorithms({"partitioner", kAbout, kEverywhere}, "NAMES|all|paper", "partitioners to compare",
                 at(&RunOptions::partitioners)),
      algorithms({"refiner", kAbout, kEverywhere}, "NAMES|all|paper", "refiners to compare",
                 at(&RunOptions::refiners)),
      word({"objective", About::partition, kRunAndReplay}, {"rows", "cost"},
           "what partitioners and refiners that aim at something lower: rows of the cut, or the modelled "
           "time of a solve, "
           "as multilevel-cost and fm-cost do",
           at(&RunOptions::objective)),
      algorithms({"solver", kAbout, kRunAndReplay}, "NAMES",
                 "solvers to compare; one that ignores parts runs once per step", at(&RunOptions::solvers)),
      text({"strategy", About::solver, kRunAndReplay}, "NAME", "strategy in place of that of every --solver",
           at(&RunOptions::strategy)),
      text({"kernel", About::solver, kRunAndReplay}, "NAME", "kernel in place of that of every --solver",
           at(&RunOptions::kernel)),
      algorithm({"advance", About::problem, kWithWorld}, "solver that advances the world in lockstep",
                at(&RunOptions::advance)),
      word({"mode", About::problem, kRunOnly}, {"lockstep", "separate"},
           "lockstep: all combinations solve the same problems; separate: one world per combination",
           at(&RunOptions::mode)),
      integer({"steps", kAbout, kRunOnly}, kNonNegative, "steps to simulate", at(&RunOptions::steps)),
      integer({"measure-every", kAbout, kRunOnly}, kAtLeastOne, "measure the last of every N steps",
              at(&RunOptions::measure_every)),
      integer({"skip", kAbout, kRunOnly}, kNonNegative, "first steps that reports leave out; recorded only",
              at(&RunOptions::skip)),
      integer({"repeats", kAbout, kEverywhere}, kAtLeastOne,
              "solves of every measured cell from the same warm start", at(&RunOptions::repeats)),
      flag({"session", About::solver, kRunAndReplay},
           "solve every step, each from what the one before left: analysis, active set and factor",
           at(&RunOptions::session)),
      repartition(),
      body_order(),
      word({"model", About::solver, kRunAndReplay}, {"full", "auto"},
           "full: every row is solved; auto: those that can matter to the step, the judge bringing back what "
           "does",
           at(&RunOptions::model)),
      integer({"threads", kAbout, kEverywhere, kChangesNoRow}, {1, 1024}, "threads of a solve",
              at(&RunOptions::threads)),
      number({"memory-limit", kAbout, kEverywhere, kChangesNoRow}, kPositive,
             "most memory of a factorisation, GB (1e9 bytes): one predicted to need more is out_of_memory; "
             "where not given, nine tenths of what the machine has available",
             at(&RunOptions::memory_limit_gb)),
      seed(),
      text({"out", kAbout, kEverywhere, kChangesNoRow}, "DIR", "directory for steps.csv and manifest.json",
           at(&RunOptions::out)),
      flag({"force", kAbout, kEverywhere, kChangesNoRow}, "take away what an earlier command left in --out",
           at(&RunOptions::force)),
      flag({"record-motion", kAbout, kRunOnly, kChangesNoRow},
           "write bodies, graph and parts of every step to motion.h5, for pictures and the viewer",
           at(&RunOptions::record_motion)),
      flag({"explain-model", kAbout, kRunOnly, kChangesNoRow},
           "write to explain_model.csv, and say, what was modelled and never mattered, and what it cost",
           at(&RunOptions::explain_model)),
  };
}

std::vector<OptionSpec> physics_options() {
  constexpr About kAbout = About::problem;
  return {
      number({"dt", kAbout, kWithWorld}, kPositive, "step h, s",
             at(&RunOptions::extract, &ExtractOptions::h_s)),
      number({"cfm", kAbout, kWithWorld}, kNonNegative, "constraint force mixing; compliance C = cfm / h",
             at(&RunOptions::extract, &ExtractOptions::cfm)),
      number({"erp", kAbout, kWithWorld}, {0, 1},
             "error reduction: share of a position error removed per step",
             at(&RunOptions::extract, &ExtractOptions::erp)),
      number({"stiffness", kAbout, kWithWorld}, kPositive,
             "k in N/m, with --damping: erp = h k / (h k + d), cfm = 1 / (h k + d)",
             at(&RunOptions::stiffness_n_per_m)),
      number({"damping", kAbout, kWithWorld}, kNonNegative, "d in N s/m, with --stiffness",
             at(&RunOptions::damping_n_s_per_m)),
      number({"gravity", kAbout, kWithWorld}, {-1e6, 1e6}, "gravity along -z, m/s^2",
             at(&RunOptions::gravity_m_per_s2)),
      integer({"contact-cap", kAbout, kWithWorld}, {1, 65535}, "most contact points of a geom pair",
              at(&RunOptions::contact_cap)),
      algorithm({"friction", kAbout, kWithWorld}, "friction model (cleave list frictions)",
                at(&RunOptions::friction)),
      number({"match-tolerance", kAbout, kWithWorld}, kNonNegative,
             "a contact continues one of the previous step within this share of the smaller shape's least "
             "extent",
             at(&RunOptions::match_tolerance)),
      flag({"skip-small-islands", About::partition, kEverywhere},
           "make every island of at most max-bodies bodies one part", at(&RunOptions::skip_small_islands)),
  };
}

std::vector<OptionSpec> all_options() {
  std::vector<OptionSpec> all = experiment_options();
  std::ranges::move(physics_options(), std::back_inserter(all));
  return all;
}

}  // namespace

std::span<const OptionSpec> run_option_specs() {
  static const std::vector<OptionSpec> specs = all_options();
  return specs;
}

const OptionSpec* find_option(const std::string& name) {
  const auto found = std::ranges::find(run_option_specs(), name, &OptionSpec::name);
  return found == run_option_specs().end() ? nullptr : &*found;
}

}  // namespace cleave
