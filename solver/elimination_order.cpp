#include "solver/elimination_order.h"

#include <camd.h>
#include <metis.h>

#include <new>
#include <stdexcept>
#include <string>
#include <vector>

namespace cleave {

static_assert(sizeof(idx_t) == sizeof(int), "METIS with indices of 32 bits");

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

void order_by_dissection(const BlockGraph& graph, std::span<int> node_at_position) {
  int count = graph.node_count();
  if (count == 0) return;
  std::vector<int> position_of_node(count);
  // It reads the graph only, but does not say so. The default options hold a fixed seed.
  const int status =
      METIS_NodeND(&count, const_cast<int*>(graph.first.data()), const_cast<int*>(graph.adjacency.data()),
                   nullptr, nullptr, node_at_position.data(), position_of_node.data());
  if (status == METIS_ERROR_MEMORY) throw std::bad_alloc();
  if (status != METIS_OK) throw std::logic_error("METIS_NodeND: status " + std::to_string(status));
}

}  // namespace cleave
