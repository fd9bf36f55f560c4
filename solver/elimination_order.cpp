#include "solver/elimination_order.h"

#include <camd.h>
#ifdef CLEAVE_METIS
#include <metis.h>
#endif

#include <new>
#include <stdexcept>
#include <string>
#include <vector>

#include "harness/base/metis_lock.h"
#include "harness/base/room.h"

namespace cleave {

void order_by_degree(const BlockGraph& graph, std::span<const int> constraint,
                     std::span<int> node_at_position) {
  if (graph.node_count() == 0) return;
  // It reads the constraint only, but does not say so.
  int* sets = constraint.empty() ? nullptr : const_cast<int*>(constraint.data());
  const int status = camd_order(graph.node_count(), graph.first.data(), graph.adjacency.data(),
                                node_at_position.data(), nullptr, nullptr, sets);
  if (status == CAMD_OUT_OF_MEMORY) throw std::bad_alloc();
  if (status != CAMD_OK) throw std::logic_error("camd_order: status " + std::to_string(status));
}

#ifdef CLEAVE_METIS

static_assert(sizeof(idx_t) == sizeof(int), "METIS with indices of 32 bits");

namespace {

constexpr int kDissectionParts = 2;            // the least that METIS_NodeNDP takes; it goes on below them
constexpr std::size_t kDissectionBytes = 100;  // more than it takes, per node and entry of the adjacency

}  // namespace

// Where METIS finds no memory it ends the process: so none without room. METIS_NodeND would put handlers of
// its own in the place of the program's, METIS_NodeNDP does not.
bool order_by_dissection(const BlockGraph& graph, std::span<int> node_at_position) {
  const std::scoped_lock lock(metis_lock());
  int count = graph.node_count();
  if (count == 0) return true;
  require_room(kDissectionBytes * (graph.first.size() + graph.adjacency.size()));
  std::vector<int> position_of_node(count), sizes(2 * kDissectionParts);
  // It reads the graph only, but does not say so.
  const int status = METIS_NodeNDP(count, const_cast<int*>(graph.first.data()),
                                   const_cast<int*>(graph.adjacency.data()), nullptr, kDissectionParts,
                                   nullptr, node_at_position.data(), position_of_node.data(), sizes.data());
  if (status != METIS_OK) throw std::logic_error("METIS_NodeNDP: status " + std::to_string(status));
  return true;
}

#else

bool order_by_dissection(const BlockGraph&, std::span<int>) { return false; }

#endif

}  // namespace cleave
