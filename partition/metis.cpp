// metis-recursive, metis-kway: the library METIS splits the graph into k = ceil(n / max-bodies) parts of
// about as many bodies each, so that little edge weight is cut. metis-recursive halves the graph, and the
// halves again; metis-kway coarsens the graph once, splits what is left so, and moves bodies among all parts
// while the graph grows back (Karypis & Kumar 1998, SIAM Journal on Scientific Computing 20, 359-392; METIS
// 5.1 manual).
//
// METIS aims at parts of at most (1 + ufactor / 1000) n / k bodies. ufactor 0 stands for the greatest at
// which such a part keeps to floor((1 + max-growth) max-bodies) bodies. metis-recursive applies it at each of
// the ceil(log2 k) halvings on the way to a part, so that there the root of that order is taken. METIS
// promises no bound: partition/README.md counts how often a part is larger.
//
// What a call changes in the whole process is put back at its end: the state of rand(), and the handlers of
// SIGABRT and SIGTERM. A SIGTERM waits meanwhile if other threads block it; taken by a thread that does not,
// it ends the process in METIS's handler.
#include <metis.h>
#include <signal.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <memory>
#include <new>
#include <stdexcept>
#include <string>
#include <vector>

#include "harness/base/metis_lock.h"
#include "partition/library_graph.h"
#include "partition/parameters.h"
#include "partition/partitioner.h"

namespace cleave {
namespace {

using Call = decltype(&METIS_PartGraphRecursive);
constexpr int kSignals[] = {SIGABRT, SIGTERM};

// One call at a time, with dice of its own and the handlers of the program put back at the end.
class ProcessState {
 public:
  ProcessState() : lock_(metis_lock()), dice_of_caller_(::initstate(1, dice_, sizeof dice_)) {
    sigset_t terminate;
    ::sigemptyset(&terminate);
    ::sigaddset(&terminate, SIGTERM);
    ::pthread_sigmask(SIG_BLOCK, &terminate, &mask_);
    for (int k = 0; k < 2; ++k) ::sigaction(kSignals[k], nullptr, &action_[k]);
  }
  ProcessState(const ProcessState&) = delete;
  ProcessState& operator=(const ProcessState&) = delete;
  ~ProcessState() {
    // METIS puts the handlers back itself, but as ones that are good for one signal.
    for (int k = 0; k < 2; ++k) ::sigaction(kSignals[k], &action_[k], nullptr);
    ::pthread_sigmask(SIG_SETMASK, &mask_, nullptr);
    ::setstate(dice_of_caller_);
  }

 private:
  std::scoped_lock<std::mutex> lock_;
  alignas(long) char dice_[128];  // as many bytes as srand() seeds of its own: the same numbers follow
  char* dice_of_caller_;
  sigset_t mask_;
  struct sigaction action_[2];
};

class Metis final : public Partitioner {
 public:
  Metis(const Settings& settings, Call call, bool halves)
      : max_bodies_(settings.integer("max-bodies")),
        max_growth_(settings.number("max-growth")),
        unit_(settings.word<EdgeWeight>(parameters::edge_weight())),
        seed_(settings.integer("partition-seed")),
        ufactor_(settings.integer("ufactor")),
        call_(call),
        halves_(halves) {}

 private:
  Partition do_run(const BodyGraph& graph) const override {
    const int parts = wanted_parts(graph.body_count(), max_bodies_);
    if (std::optional<Partition> split = split_without_choice(graph, parts)) return *std::move(split);
    LibraryGraph<idx_t> arrays(graph, unit_);
    idx_t options[METIS_NOPTIONS];
    METIS_SetDefaultOptions(options);
    options[METIS_OPTION_NUMBERING] = 0;
    options[METIS_OPTION_SEED] = seed_;
    options[METIS_OPTION_UFACTOR] = ufactor(graph.body_count(), parts);
    idx_t bodies = graph.body_count(), constraints = 1, count = parts, cut = 0;
    std::vector<idx_t> part_of_body(bodies);
    const int status = [&] {
      const ProcessState state;
      return call_(&bodies, &constraints, arrays.first.data(), arrays.neighbour.data(), nullptr, nullptr,
                   arrays.weight.data(), &count, nullptr, nullptr, options, &cut, part_of_body.data());
    }();
    if (status == METIS_ERROR_MEMORY) throw std::bad_alloc();
    if (status != METIS_OK) throw std::runtime_error("METIS ended with status " + std::to_string(status));
    return numbered_by_lowest_body(std::vector<int>(part_of_body.begin(), part_of_body.end()));
  }

  idx_t ufactor(int bodies, int parts) const {
    if (ufactor_ > 0) return ufactor_;
    const double most = std::min(bodies, most_grown_bodies(max_bodies_, max_growth_));
    const double ratio = most * parts / bodies;
    const double step = halves_ ? std::pow(ratio, 1 / std::ceil(std::log2(parts))) : ratio;
    return std::max(1, static_cast<int>(1000 * (step - 1)));  // 1: the least that METIS takes
  }

  int max_bodies_;
  double max_growth_;
  EdgeWeight unit_;
  int seed_, ufactor_;
  Call call_;
  bool halves_;
};

}  // namespace

std::unique_ptr<Partitioner> make_metis_recursive(const Settings& settings) {
  return std::make_unique<Metis>(settings, METIS_PartGraphRecursive, true);
}

std::unique_ptr<Partitioner> make_metis_kway(const Settings& settings) {
  return std::make_unique<Metis>(settings, METIS_PartGraphKway, false);
}

}  // namespace cleave
