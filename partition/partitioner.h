// A partitioner splits the bodies of a step into parts.
//
// All five of the paper (Liu & Andrews 2022, section 3.1) grow parts with one loop (grow.h) and differ in the
// body they choose next, of equal ones that of the lowest index. What numbers parts otherwise than by growing
// or by their lowest body says so. To add one: a new file, its make_...() and a row in registry.cpp; the row
// declares its parameters and promises what its parts are.
#pragma once

#include <optional>
#include <stdexcept>
#include <string>

#include "partition/body_graph.h"
#include "partition/partition.h"

namespace cleave {

// What the parts of an algorithm always are. Whatever it promises, every body has one part and no part is
// empty.
struct PartsPromise {
  bool contiguous = false;            // every part is connected within itself
  bool at_most_max_bodies = false;    // no part has more bodies than its parameter max-bodies says
  bool at_most_grown_bodies = false;  // nor more than floor((1 + max-growth) max-bodies + 1e-9)
  bool grown_in_order = false;  // ids in order of growth, each part as far as it goes: one of fewer than
                                // max-bodies bodies touches no later one
};

// This graph cannot be split by this partitioner, though others can: one line that says why.
struct CannotSplit : std::runtime_error {
  using std::runtime_error::runtime_error;
};

class Partitioner {
 public:
  virtual ~Partitioner() = default;

  // Runs, and asserts that every body is in exactly one part, that none is empty, and what was promised.
  // Throws CannotSplit, and Stopped where it takes long and the program is asked to stop
  // (harness/base/stop_signals.h).
  Partition run(const BodyGraph& graph) const;

  // From its row, by make_partitioner (registry.h). max_bodies: its parameter of this name, if it has one;
  // grown_bodies: what max-growth makes of it, if it has that too.
  void promise(const PartsPromise& promise, std::optional<int> max_bodies,
               std::optional<int> grown_bodies = std::nullopt) {
    promise_ = promise;
    max_bodies_ = max_bodies;
    grown_bodies_ = grown_bodies;
  }
  std::optional<int> max_bodies() const { return max_bodies_; }

  // For one that chooses others: makes this choice (Partition::choice), and no other, from now on. Throws
  // std::invalid_argument for one that it does not make.
  virtual void keep_choice(const std::string& choice);
  const PartsPromise& promised() const { return promise_; }

 private:
  virtual Partition do_run(const BodyGraph& graph) const = 0;

  PartsPromise promise_;
  std::optional<int> max_bodies_, grown_bodies_;
};

// Empty, or the one thing that is wrong, in words: "part 3 has 30 bodies, promised were at most 25".
std::string find_broken_promise(const BodyGraph& graph, const Partition& partition,
                                const PartsPromise& promise, std::optional<int> max_bodies,
                                std::optional<int> grown_bodies = std::nullopt);

}  // namespace cleave
