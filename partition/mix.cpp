// mix: Algorithm 1 of Liu & Andrews 2022, section 3.1. While the part has fewer than tau_mix * max_bodies
// bodies, none included, the seed or the adjacent body of least degree joins (as in mindp), afterwards the
// adjacent body i of G0 with the greatest sum of edge weights into the part,
//
//     W_i = sum over j in the part of w_ij,
//
// in the unit edge-weight (as-printed: constraints). Ties go to the lowest body index, so that
// with tau_mix = 0 it is also the seed.
#include <memory>

#include "partition/degree_chooser.h"
#include "partition/partitioner.h"

namespace cleave {
namespace {

struct MixOptions {
  int max_bodies;
  double tau_mix;
  Degree degree;
  EdgeWeight unit;  // of the weight into the part
};

MixOptions read_options(const Settings& settings) {
  const EdgeWeight asked = settings.word<EdgeWeight>(parameters::edge_weight());
  return {settings.integer("max-bodies"), settings.number("tau-mix"), read_degree(settings),
          settings.flag("as-printed") ? EdgeWeight::constraints : asked};
}

class MixChooser final : public DegreeChooser {
 public:
  MixChooser(const BodyGraph& graph, const MixOptions& options)
      : DegreeChooser(graph, Order::least, options.degree),
        by_degree_(options.tau_mix * options.max_bodies),
        unit_(options.unit),
        weight_(graph.body_count(), 0),
        weight_of_(graph.body_count(), -1) {
    reached_.reserve(graph.body_count());
  }

  int seed(const Growth& growth) override {
    reached_.clear();
    heaviest_.clear();
    weighing_ = false;
    if (by_degree_ > 0) return DegreeChooser::seed(growth);
    lowest_left_ = growth.lowest_left(lowest_left_);  // nothing has weight into an empty part
    return lowest_left_;
  }

  int next(const Growth& growth) override {
    if (growth.open_bodies < by_degree_) return DegreeChooser::next(growth);
    if (!weighing_) start_weighing(growth);
    while (!heaviest_.empty()) {
      const BodyHeap::Entry entry = heaviest_.pop();
      if (growth.is_left(entry.body) && entry.key == -weight_[entry.body]) return entry.body;
    }
    return -1;
  }

  void joined(const Growth& growth, int body) override {
    DegreeChooser::joined(growth, body);
    for (int k = growth.graph.first(body); k < growth.graph.last(body); ++k) {
      const int other = growth.graph.neighbour(k);
      if (!growth.is_left(other)) continue;
      if (weight_of_[other] != growth.open_part()) {
        weight_of_[other] = growth.open_part();
        weight_[other] = 0;
        reached_.push_back(other);
      }
      weight_[other] += growth.graph.weight(k, unit_);
      if (weighing_) heaviest_.push(-weight_[other], other);
    }
  }

 private:
  // While degrees decide, weights are only added up; the heap is built once they count.
  void start_weighing(const Growth& growth) {
    weighing_ = true;
    for (int body : reached_) {
      if (growth.is_left(body)) heaviest_.push(-weight_[body], body);
    }
  }

  const double by_degree_;  // part size from which weights decide
  const EdgeWeight unit_;
  std::vector<int> weight_;     // (n): W_i into part weight_of_
  std::vector<int> weight_of_;  // (n)
  std::vector<int> reached_;    // bodies found adjacent to the open part
  BodyHeap heaviest_;           // key -W_i
  bool weighing_ = false;
  int lowest_left_ = 0;
};

class Mix final : public Partitioner {
 public:
  explicit Mix(const Settings& settings) : options_(read_options(settings)) {}

 private:
  Partition do_run(const BodyGraph& graph) const override {
    MixChooser chooser(graph, options_);
    return grow(graph, options_.max_bodies, chooser);
  }

  MixOptions options_;
};

}  // namespace

std::unique_ptr<Partitioner> make_mix(const Settings& settings) { return std::make_unique<Mix>(settings); }

}  // namespace cleave
