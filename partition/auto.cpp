// auto: the partitioner, size of parts and refiner whose modelled time (cost_model.h) is least.
//
// Candidates are one part with all bodies, and every partitioner, max-bodies and refiner of the table below whose parts
// are smaller than the whole; the first of equal ones is taken, so that one subsystem wins where splitting buys nothing.
// Looking takes longer than many a solve, so a choice serves while the graph is of its size: it is made on the first graph
// with an edge, and again on one whose edges are a quarter more or a fifth fewer. What was chosen is Partition::choice.
#include <algorithm>
#include <array>
#include <limits>
#include <memory>
#include <optional>

#include "partition/calibration.h"
#include "partition/parameters.h"
#include "partition/partitioner.h"
#include "partition/refuse.h"
#include "partition/registry.h"

namespace cleave {
namespace {

constexpr std::array kPartitioners = {"mindp", "mix", "multilevel"};
constexpr std::array kMaxBodies = {10, 25, 50, 100, 200};
constexpr std::array kRefiners = {"none", "fm"};
constexpr double kOtherSize = 1.25;  // a ratio of edges from which on a choice is made again

// "mix@max-bodies=50+fm".
struct Candidate {
  std::string text;
  std::unique_ptr<Partitioner> partitioner;
  std::unique_ptr<Refiner> refiner;
};

Candidate make_candidate(const std::string& partitioner, const std::string& refiner) {
  return {partitioner + "+" + refiner, make_partitioner(partitioner), make_refiner(refiner)};
}

Partition split(const Candidate& candidate, const BodyGraph& graph) {
  Partition parts = candidate.partitioner->run(graph);
  candidate.refiner->run(graph, candidate.partitioner->max_bodies().value_or(std::max(1, graph.body_count())),
                         parts);
  return parts;
}

class Auto final : public Partitioner {
 public:
  explicit Auto(const Settings& settings)
      : cost_(kernel_cost(settings)), kernel_(settings.text(parameters::cost_kernel().name)) {
    candidates_.push_back(make_candidate("single", "none"));
    for (const int max_bodies : kMaxBodies)
      for (const char* partitioner : kPartitioners)
        for (const char* refiner : kRefiners)
          candidates_.push_back(
              make_candidate(partitioner + ("@max-bodies=" + std::to_string(max_bodies)), refiner));
  }

  void keep_choice(const std::string& choice) override {
    std::size_t k = 0;
    while (k < candidates_.size() && named(k) != choice) ++k;
    if (k == candidates_.size())
      refuse("choice of auto", choice, "one that it makes with cost-kernel " + kernel_);
    chosen_ = k;
    kept_ = true;
  }

 private:
  Partition do_run(const BodyGraph& graph) const override {
    if (!kept_ && graph.edge_count() > 0 && is_of_other_size(graph.edge_count())) choose(graph);
    const std::size_t chosen = chosen_.value_or(0);
    Partition parts = split(candidates_[chosen], graph);
    parts.choice = named(chosen);
    return parts;
  }

  // As every graph is to a choice that was not made yet, on 0 edges.
  bool is_of_other_size(double edges) const {
    return edges >= kOtherSize * edges_ || kOtherSize * edges <= edges_;
  }

  void choose(const BodyGraph& graph) const {
    CostCounter counter(graph, cost_.kernel, cost_.active_share);
    double least_ms = std::numeric_limits<double>::infinity();
    for (std::size_t k = 0; k < candidates_.size(); ++k) {
      if (k > 0 && *candidates_[k].partitioner->max_bodies() >= graph.body_count()) continue;
      const Partition parts = split(candidates_[k], graph);
      const double ms = modelled_ms(counter.count(parts.part_of_body, parts.part_count), cost_);
      if (ms < least_ms) least_ms = ms, chosen_ = k;
    }
    edges_ = graph.edge_count();
  }

  std::string named(std::size_t k) const { return candidates_[k].text + "/" + kernel_; }

  KernelCost cost_;
  std::string kernel_;
  std::vector<Candidate> candidates_;
  // The choice that serves, and the edges of the graph that it was made on.
  mutable std::optional<std::size_t> chosen_;
  mutable double edges_ = 0;
  bool kept_ = false;  // one that was made before
};

}  // namespace

std::unique_ptr<Partitioner> make_auto(const Settings& settings) { return std::make_unique<Auto>(settings); }

}  // namespace cleave
