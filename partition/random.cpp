// random: bodies dealt at random, as a control that every partitioner must beat. The bodies are shuffled
// (harness/base/dice.h) and dealt in turn to
//
//     k = ceil(n / max-bodies)
//
// parts, so that sizes differ by one at most.
#include <memory>
#include <vector>

#include "harness/base/dice.h"
#include "harness/base/parameter.h"
#include "partition/partitioner.h"

namespace cleave {
namespace {

class Random final : public Partitioner {
 public:
  explicit Random(const Settings& settings)
      : max_bodies_(settings.integer("max-bodies")), seed_(settings.integer("partition-seed")) {}

 private:
  Partition do_run(const BodyGraph& graph) const override {
    const int n = graph.body_count();
    const int parts = wanted_parts(n, max_bodies_);
    const std::vector<int> order = shuffled(n, Dice(seed_));
    std::vector<int> label_of_body(n);
    for (int place = 0; place < n; ++place) label_of_body[order[place]] = place % parts;
    return numbered_by_lowest_body(label_of_body);
  }

  int max_bodies_, seed_;
};

}  // namespace

std::unique_ptr<Partitioner> make_random(const Settings& settings) {
  return std::make_unique<Random>(settings);
}

}  // namespace cleave
