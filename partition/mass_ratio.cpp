// mr: mass ratio (Liu & Andrews 2022, section 3.1). The seed is the lowest body in G0; then the lowest body j
// of G0 adjacent to the part joins for which
//
//     max(m_i, m_j) / min(m_i, m_j) < tau_mr,     m_i = least mass in the part so far,
//
// and the part closes when there is none. As m_i falls, heavy bodies drop out for good and light ones come
// in.
#include <algorithm>
#include <memory>

#include "harness/base/parameter.h"
#include "partition/grow.h"
#include "partition/partitioner.h"

namespace cleave {
namespace {

class MassRatioChooser final : public Chooser {
 public:
  MassRatioChooser(int bodies, double tau_mr) : tau_mr_(tau_mr), seen_by_(bodies, -1) {}

  int seed(const Growth& growth) override {
    fitting_.clear();
    too_light_.clear();
    lowest_left_ = growth.lowest_left(lowest_left_);
    least_kg_ = growth.graph.mass_kg(lowest_left_);
    return lowest_left_;
  }

  int next(const Growth& growth) override {
    while (!fitting_.empty()) {
      const int body = fitting_.pop().body;
      if (fits(growth.graph.mass_kg(body))) return body;  // else too heavy since the least mass fell
    }
    return -1;
  }

  void joined(const Growth& growth, int body) override {
    if (growth.graph.mass_kg(body) < least_kg_) {
      least_kg_ = growth.graph.mass_kg(body);
      readmit(growth);
    }
    for (int other : growth.graph.neighbours(body)) {
      if (!growth.is_left(other) || seen_by_[other] == growth.open_part()) continue;
      seen_by_[other] = growth.open_part();
      admit(growth, other);
    }
  }

 private:
  bool fits(double mass_kg) const {
    return std::max(mass_kg, least_kg_) / std::min(mass_kg, least_kg_) < tau_mr_;
  }

  void admit(const Growth& growth, int body) {
    if (fits(growth.graph.mass_kg(body))) {
      fitting_.push(0, body);
    } else if (growth.graph.mass_kg(body) < least_kg_) {
      too_light_.push_back(body);
    }
  }

  void readmit(const Growth& growth) {
    waiting_.swap(too_light_);
    too_light_.clear();
    for (int body : waiting_) admit(growth, body);
  }

  const double tau_mr_;
  double least_kg_ = 0;
  int lowest_left_ = 0;
  std::vector<int> seen_by_;    // (n): the last part that saw the body as adjacent, -1 for none
  BodyHeap fitting_;            // by index
  std::vector<int> too_light_;  // adjacent, but not before the least mass falls
  std::vector<int> waiting_;    // scratch of readmit
};

class MassRatio final : public Partitioner {
 public:
  explicit MassRatio(const Settings& settings)
      : max_bodies_(settings.integer("max-bodies")), tau_mr_(settings.number("tau-mr")) {}

 private:
  Partition do_run(const BodyGraph& graph) const override {
    MassRatioChooser chooser(graph.body_count(), tau_mr_);
    return grow(graph, max_bodies_, chooser);
  }

  int max_bodies_;
  double tau_mr_;
};

}  // namespace

std::unique_ptr<Partitioner> make_mass_ratio(const Settings& settings) {
  return std::make_unique<MassRatio>(settings);
}

}  // namespace cleave
