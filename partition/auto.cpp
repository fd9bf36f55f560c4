// auto: the partitioner, size of parts and refiner whose modelled time (cost_model.h) is least, and with
// cost-kernel `any` the kernel.
//
// Candidates are one part with all bodies, and every partitioner, max-bodies and refiner of the table below
// whose parts are smaller than the whole, each with every kernel that is asked for; `monolithic` splits
// nothing and is one of one part, and `schur-nested` has its parts by recursion (nested.h), in a tree of
// pairs. What splits must be modelled to save a twentieth of what one part takes: the model is off by more,
// and splitting takes time of its own, which it does not count. The first of equal ones is taken.
// Looking takes longer than many a solve, so a choice serves while the graph is of its size: it is made on
// the first graph with an edge, and again on one whose edges are a quarter more or a fifth fewer. What was
// chosen is Partition::choice.
#include <algorithm>
#include <array>
#include <limits>
#include <memory>
#include <optional>

#include "partition/calibration.h"
#include "partition/nested.h"
#include "partition/parameters.h"
#include "partition/partitioner.h"
#include "partition/refuse.h"
#include "partition/registry.h"

namespace cleave {
namespace {

constexpr std::array kPartitioners = {"mindp", "mix", "multilevel"};
constexpr std::array kMaxBodies = {10, 25, 50, 100, 200};
constexpr std::array kRefiners = {"none", "fm"};
constexpr int kArity = 2;
constexpr double kWorthSplitting = 1.05;  // what one part takes over what a split may at most
constexpr double kOtherSize = 1.25;       // a ratio of edges from which on a choice is made again

class Candidate {
 public:
  Candidate(const std::string& partitioner, const std::string& refiner)
      : text_(partitioner + "+" + refiner),
        partitioner_(make_partitioner(partitioner)),
        refiner_(make_refiner(refiner)) {
    if (partitioner_->max_bodies())
      set_splitter_.emplace(read_partitioner(partitioner), read_refiner(refiner), kArity);
  }

  // "mix@max-bodies=50+fm".
  const std::string& text() const { return text_; }
  bool splits(const BodyGraph& graph) const {
    return partitioner_->max_bodies() && *partitioner_->max_bodies() < graph.body_count();
  }

  Partition split_once(const BodyGraph& graph) const {
    Partition parts = partitioner_->run(graph);
    refiner_->run(graph, partitioner_->max_bodies().value_or(std::max(1, graph.body_count())), parts);
    return parts;
  }

  // Into a tree, where it splits at all.
  Partition split_for(CostKernel kernel, const BodyGraph& graph) const {
    return kernel == CostKernel::schur_nested && splits(graph) ? set_splitter_->run(graph)
                                                               : split_once(graph);
  }

 private:
  std::string text_;
  std::unique_ptr<Partitioner> partitioner_;
  std::unique_ptr<Refiner> refiner_;
  std::optional<SetSplitter> set_splitter_;
};

// Places in candidates_ and costs_.
struct Choice {
  std::size_t candidate = 0, cost = 0;
};

class Auto final : public Partitioner {
 public:
  explicit Auto(const Settings& settings)
      : costs_(kernel_costs(settings)), cost_kernel_(settings.text(parameters::cost_kernel().name)) {
    candidates_.emplace_back("single", "none");
    for (const int max_bodies : kMaxBodies)
      for (const char* partitioner : kPartitioners)
        for (const char* refiner : kRefiners)
          candidates_.emplace_back(partitioner + ("@max-bodies=" + std::to_string(max_bodies)), refiner);
  }

  void keep_choice(const std::string& choice) override {
    for (std::size_t k = 0; k < candidates_.size(); ++k)
      for (std::size_t c = 0; c < costs_.size(); ++c)
        if (is_choice({k, c}) && named({k, c}) == choice) {
          chosen_ = {k, c};
          kept_ = true;
          return;
        }
    refuse("choice of auto", choice, "one that it makes with cost-kernel " + cost_kernel_);
  }

 private:
  Partition do_run(const BodyGraph& graph) const override {
    if (!kept_ && graph.edge_count() > 0 && is_of_other_size(graph.edge_count())) choose(graph);
    Partition parts = candidates_[chosen_.candidate].split_for(costs_[chosen_.cost].kernel, graph);
    parts.choice = named(chosen_);
    return parts;
  }

  // As every graph is to a choice that was not made yet, on 0 edges.
  bool is_of_other_size(double edges) const {
    return edges >= kOtherSize * edges_ || kOtherSize * edges <= edges_;
  }

  // What splits nothing is a choice of one part, the first candidate.
  bool is_choice(const Choice& choice) const {
    return choice.candidate == 0 || costs_[choice.cost].kernel != CostKernel::monolithic;
  }

  void choose(const BodyGraph& graph) const {
    std::vector<CostCounter> counters;
    for (const KernelCost& cost : costs_) counters.push_back(cost_counter(graph, cost));
    double least_ms = std::numeric_limits<double>::infinity();
    for (std::size_t k = 0; k < candidates_.size(); ++k) {
      if (k > 0 && !candidates_[k].splits(graph)) continue;
      std::optional<Partition> one_level, tree;
      for (std::size_t c = 0; c < costs_.size(); ++c) {
        if (!is_choice({k, c})) continue;
        const CostKernel kernel = costs_[c].kernel;
        std::optional<Partition>& parts = kernel == CostKernel::schur_nested ? tree : one_level;
        if (!parts) parts = candidates_[k].split_for(kernel, graph);
        const double ms = modelled_ms(counters[c].count(*parts), costs_[c]) * (k > 0 ? kWorthSplitting : 1.0);
        if (ms < least_ms) least_ms = ms, chosen_ = {k, c};
      }
    }
    edges_ = graph.edge_count();
  }

  std::string named(const Choice& choice) const {
    const int kernel = static_cast<int>(costs_[choice.cost].kernel);
    return candidates_[choice.candidate].text() + "/" + cost_kernel_names()[kernel];
  }

  std::vector<KernelCost> costs_;  // of the kernels to choose among
  std::string cost_kernel_;
  std::vector<Candidate> candidates_;
  // The choice that serves, and the edges of the graph that it was made on.
  mutable Choice chosen_;
  mutable double edges_ = 0;
  bool kept_ = false;  // one that was made before
};

}  // namespace

std::unique_ptr<Partitioner> make_auto(const Settings& settings) { return std::make_unique<Auto>(settings); }

}  // namespace cleave
