// Dice that fall alike on every machine: the 64-bit Mersenne Twister (Matsumoto & Nishimura 1998), whose bits
// the C++ standard fixes, and integer arithmetic on them. The distributions of the standard library differ
// between implementations.
#pragma once

#include <cstddef>
#include <cstdint>
#include <numeric>
#include <random>
#include <utility>
#include <vector>

namespace cleave {

class Dice {
 public:
  explicit Dice(std::uint64_t seed) : engine_(seed) {}

  // Every integer in [0, count) is equally likely. count >= 1. The lowest 2^64 mod count words are thrown
  // away, so that as many words stay for each.
  std::uint64_t below(std::uint64_t count) {
    const std::uint64_t thrown_away = (0 - count) % count;
    std::uint64_t word = engine_();
    while (word < thrown_away) word = engine_();
    return word % count;
  }

 private:
  std::mt19937_64 engine_;
};

// Every order is equally likely (Fisher & Yates 1938, Durstenfeld 1964).
template <class Item>
void shuffle(std::vector<Item>& items, Dice& dice) {
  for (std::size_t left = items.size(); left > 1; --left) std::swap(items[left - 1], items[dice.below(left)]);
}

// 0 to count - 1, shuffled.
inline std::vector<int> shuffled(int count, Dice dice) {
  std::vector<int> order(count);
  std::iota(order.begin(), order.end(), 0);
  shuffle(order, dice);
  return order;
}

}  // namespace cleave
