// karger-cost and multilevel-cost: of several trials of `karger` or `multilevel` the one whose modelled time
// (cost_model.h) is least,
//
//     parts = P_t,  t = argmin t_s(P_t),  0 <= t < trials
//
// of equal ones the earliest. P_t are the parts of one trial with dice of seed (partition-seed + t) mod 2^31.
// Each is found as the cut asks for, and only chosen by its time: `fm-cost` is what lowers the time of the
// one that is chosen.
#include <limits>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "harness/base/stop.h"
#include "harness/base/stop_signals.h"
#include "partition/calibration.h"
#include "partition/partitioner.h"
#include "partition/registry.h"

namespace cleave {
namespace {

int seed_of_trial(const Settings& settings, int trial) {
  return static_cast<int>((static_cast<long>(settings.integer("partition-seed")) + trial) % (1L << 31));
}

// `name` with what the settings say of its parameters, tried once.
std::unique_ptr<Partitioner> make_trial(const std::string& name, const Settings& settings, int trial) {
  Algorithm one = read_partitioner(name);
  std::map<std::string, std::string> values = one.settings.values();
  for (auto& [parameter, value] : values) value = settings.text(parameter);
  values["partition-seed"] = std::to_string(seed_of_trial(settings, trial));
  if (values.contains("trials")) values["trials"] = "1";
  one.settings = Settings(values);
  return make_partitioner(one);
}

class CheapestTrial final : public Partitioner {
 public:
  CheapestTrial(const std::string& name, int trials, const Settings& settings)
      : cost_(kernel_cost(settings)) {
    for (int trial = 0; trial < trials; ++trial) trials_.push_back(make_trial(name, settings, trial));
  }

 private:
  Partition do_run(const BodyGraph& graph) const override {
    CostCounter counter = cost_counter(graph, cost_);
    double least_ms = std::numeric_limits<double>::infinity();
    Partition cheapest;
    for (const auto& trial : trials_) {
      check_stop(&stop_requested());
      Partition parts = trial->run(graph);
      const double ms = modelled_ms(counter.count(parts), cost_);
      if (cheapest.part_count > 0 && ms >= least_ms) continue;
      least_ms = ms;
      cheapest = std::move(parts);
    }
    return cheapest;
  }

  KernelCost cost_;
  std::vector<std::unique_ptr<Partitioner>> trials_;
};

}  // namespace

std::unique_ptr<Partitioner> make_karger_cost(const Settings& settings) {
  return std::make_unique<CheapestTrial>("karger", settings.integer("trials"), settings);
}

std::unique_ptr<Partitioner> make_multilevel_cost(const Settings& settings) {
  return std::make_unique<CheapestTrial>("multilevel", settings.integer("seeds"), settings);
}

}  // namespace cleave
