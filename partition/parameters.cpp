#include "partition/parameters.h"

#include <limits>

#include "partition/calibration.h"

namespace cleave::parameters {
namespace {

using Kind = Parameter::Kind;
constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr const char* kGrowing = "Liu & Andrews 2022, section 3.1";
constexpr const char* kRefining = "Liu & Andrews 2022, section 3.2";

}  // namespace

const Parameter& max_bodies() {
  static const Parameter parameter{.name = "max-bodies",
                                   .kind = Kind::integer,
                                   .default_value = "25",
                                   .range = {1, kInfinity},
                                   .help = "n_max: most bodies of a part while growing",
                                   .source = kGrowing};
  return parameter;
}

const Parameter& degree() {
  static const Parameter parameter{.name = "degree",
                                   .kind = Kind::word,
                                   .default_value = "bodies",
                                   .words = {"bodies", "constraints"},
                                   .help = "what the degree of a body counts",
                                   .source = kGrowing};
  return parameter;
}

// The paper leaves the scope open; among what is left cuts fewer rows with mindp and mix
// (partition/README.md).
const Parameter& degree_scope() {
  static const Parameter parameter{
      .name = "degree-scope",
      .kind = Kind::word,
      .default_value = "left",
      .words = {"whole", "left"},
      .help = "count degrees in the whole graph or among bodies not yet in a part",
      .source = "partition/README.md"};
  return parameter;
}

const Parameter& edge_weight() {
  static const Parameter parameter{.name = "edge-weight",
                                   .kind = Kind::word,
                                   .default_value = "rows",
                                   .words = {"pairs", "constraints", "rows"},
                                   .help = "unit of edge weights",
                                   .source = "partition/README.md"};
  return parameter;
}

const Parameter& as_printed() {
  static const Parameter parameter{.name = "as-printed",
                                   .kind = Kind::flag,
                                   .default_value = "false",
                                   .help =
                                       "the paper to the letter: pairs in kl and fm, constraints in mix and "
                                       "maxdp, no bound on a part in fm",
                                   .source = "Liu & Andrews 2022, section 3"};
  return parameter;
}

const Parameter& tau_mr() {
  static const Parameter parameter{.name = "tau-mr",
                                   .kind = Kind::number,
                                   .default_value = "10",
                                   .range = {1, kInfinity, true},
                                   .help = "mr joins bodies of mass ratio below this",
                                   .source = kGrowing};
  return parameter;
}

const Parameter& tau_mix() {
  static const Parameter parameter{.name = "tau-mix",
                                   .kind = Kind::number,
                                   .default_value = "0.5",
                                   .range = {0, 1},
                                   .help = "mix grows this share of a part by least degree",
                                   .source = "Liu & Andrews 2022, Algorithm 1"};
  return parameter;
}

const Parameter& max_growth() {
  static const Parameter parameter{.name = "max-growth",
                                   .kind = Kind::number,
                                   .default_value = "0.2",
                                   .range = {0, kInfinity},
                                   .help = "a part may grow to (1 + this) max-bodies",
                                   .source = kRefining};
  return parameter;
}

const Parameter& merge_small() {
  static const Parameter parameter{.name = "merge-small",
                                   .kind = Kind::flag,
                                   .default_value = "false",
                                   .help = "mend grown parts: as many as wanted, and fewer rows cut",
                                   .source = "partition/README.md"};
  return parameter;
}

const Parameter& partition_seed() {
  static const Parameter parameter{.name = "partition-seed",
                                   .kind = Kind::integer,
                                   .default_value = "1",
                                   .range = {0, kInfinity},
                                   .help = "seed of a partitioner that draws at random",
                                   .source = "partition/README.md"};
  return parameter;
}

const Parameter& trials() {
  static const Parameter parameter{.name = "trials",
                                   .kind = Kind::integer,
                                   .default_value = "100",
                                   .range = {1, kInfinity},
                                   .help = "trials of karger, of which the best counts",
                                   .source = "partition/README.md"};
  return parameter;
}

const Parameter& karger_method() {
  static const Parameter parameter{
      .name = "karger-method",
      .kind = Kind::word,
      .default_value = "contract",
      .words = {"contract", "recursive-bisection"},
      .help = "contract to the wanted number of parts, or halve by least cuts until parts are small",
      .source = "partition/README.md"};
  return parameter;
}

const Parameter& effort() {
  static const Parameter parameter{.name = "effort",
                                   .kind = Kind::word,
                                   .default_value = "fast",
                                   .words = {"fast", "best"},
                                   .help = "few starts on joined bodies, or several on all",
                                   .source = "partition/README.md"};
  return parameter;
}

const Parameter& ufactor() {
  static const Parameter parameter{
      .name = "ufactor",
      .kind = Kind::integer,
      .default_value = "0",
      .range = {0, kInfinity},
      .help = "thousandths by which METIS may let a part exceed its share; 0: those of max-growth",
      .source = "METIS 5.1 manual"};
  return parameter;
}

const Parameter& scotch_strategy() {
  static const Parameter parameter{.name = "scotch-strategy",
                                   .kind = Kind::word,
                                   .default_value = "default",
                                   .words = {"default", "quality", "speed", "balance", "safety"},
                                   .help = "what SCOTCH cares for most",
                                   .source = "SCOTCH 7.0 user's guide"};
  return parameter;
}

const Parameter& calibration() {
  static const Parameter parameter{.name = "calibration",
                                   .kind = Kind::content,
                                   .default_value = "shipped",
                                   .help = "costs that cleave calibrate fitted, by their fingerprint",
                                   .source = "partition/README.md",
                                   .read_content = read_calibration};
  return parameter;
}

const Parameter& cost_kernel() {
  static const Parameter parameter{.name = "cost-kernel",
                                   .kind = Kind::word,
                                   .default_value = "schur-rows",
                                   .words = {"schur-rows", "schur-bodies", "schur-nested", kAnyKernel},
                                   .help = "kernel whose time is modelled; any: auto chooses among all",
                                   .source = "partition/README.md"};
  return parameter;
}

// Not those of the solve, so that parts do not depend on the number of threads.
const Parameter& cost_threads() {
  static const Parameter parameter{.name = "cost-threads",
                                   .kind = Kind::integer,
                                   .default_value = "1",
                                   .range = {1, 65536},
                                   .help = "threads on which its time is modelled",
                                   .source = "partition/README.md"};
  return parameter;
}

}  // namespace cleave::parameters
