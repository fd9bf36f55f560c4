#include "partition/grow.h"

#include <algorithm>
#include <functional>
#include <utility>

namespace cleave {
namespace {

// Maps int to unsigned in the same order, negative keys first.
constexpr std::uint32_t kSignBit = 0x80000000u;

}  // namespace

Partition grow(const BodyGraph& graph, int max_bodies, Chooser& chooser) {
  Growth growth{graph, {std::vector<int>(graph.body_count(), -1), 0}, 0};
  int left = graph.body_count();
  while (left > 0) {
    ++growth.partition.part_count;
    growth.open_bodies = 0;
    for (int body = chooser.seed(growth); body >= 0;) {
      growth.partition.part_of_body[body] = growth.open_part();
      ++growth.open_bodies;
      --left;
      chooser.joined(growth, body);
      body = growth.open_bodies < max_bodies ? chooser.next(growth) : -1;
    }
  }
  return std::move(growth.partition);
}

void BodyHeap::push(int key, int body) {
  const std::uint32_t sortable_key = static_cast<std::uint32_t>(key) ^ kSignBit;
  entries_.push_back(std::uint64_t{sortable_key} << 32 | static_cast<std::uint32_t>(body));
  std::push_heap(entries_.begin(), entries_.end(), std::greater<>());
}

BodyHeap::Entry BodyHeap::pop() {
  std::pop_heap(entries_.begin(), entries_.end(), std::greater<>());
  const std::uint64_t entry = entries_.back();
  entries_.pop_back();
  return {static_cast<int>(static_cast<std::uint32_t>(entry >> 32) ^ kSignBit), static_cast<int>(entry)};
}

}  // namespace cleave
