// stripes: bodies in the order of their indices, `stripe-bodies` to a part, whatever the graph. A control:
// what a partition costs that looks at nothing.
#include <memory>

#include "harness/base/parameter.h"
#include "partition/partitioner.h"

namespace cleave {
namespace {

class Stripes final : public Partitioner {
 public:
  explicit Stripes(int stripe_bodies) : stripe_bodies_(stripe_bodies) {}

 private:
  Partition do_run(const BodyGraph& graph) const override {
    Partition partition;
    for (int body = 0; body < graph.body_count(); ++body)
      partition.part_of_body.push_back(body / stripe_bodies_);
    partition.part_count = (graph.body_count() + stripe_bodies_ - 1) / stripe_bodies_;
    return partition;
  }

  int stripe_bodies_;
};

}  // namespace

std::unique_ptr<Partitioner> make_stripes(const Settings& settings) {
  return std::make_unique<Stripes>(settings.integer("stripe-bodies"));
}

}  // namespace cleave
