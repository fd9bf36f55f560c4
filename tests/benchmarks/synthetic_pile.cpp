#include "tests/benchmarks/synthetic_pile.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <tuple>
#include <utility>
#include <vector>

namespace cleave {
namespace {

double uniform(std::mt19937_64& random, double low, double high) {
  return low + (high - low) * (static_cast<double>(random() >> 11) * 0x1p-53);
}

struct Site {
  std::array<int, 3> cell;
  std::array<double, 3> centre;
};

// Body i lies in cell i, along x, then y, then z.
int body_at(const std::array<int, 3>& cell, int side) { return cell[0] + side * (cell[1] + side * cell[2]); }

std::vector<Site> settle(int bodies, int side, std::mt19937_64& random) {
  std::vector<Site> sites(bodies);
  for (int i = 0; i < bodies; ++i) {
    sites[i].cell = {i % side, i / side % side, i / (side * side)};
    for (int axis = 0; axis < 3; ++axis)
      sites[i].centre[axis] = sites[i].cell[axis] + uniform(random, -0.3, 0.3);
  }
  return sites;
}

// Pairs of bodies in neighbouring cells, closest first.
std::vector<std::pair<int, int>> close_pairs(const std::vector<Site>& sites, int side) {
  std::vector<std::tuple<double, int, int>> pairs;
  const int n = static_cast<int>(sites.size());
  for (int a = 0; a < n; ++a) {
    for (int step = 0; step < 27; ++step) {
      std::array<int, 3> cell = sites[a].cell;
      for (int axis = 0, left = step; axis < 3; ++axis, left /= 3) cell[axis] += left % 3 - 1;
      if (std::min({cell[0], cell[1], cell[2]}) < 0 || cell[0] >= side || cell[1] >= side) continue;
      const int b = body_at(cell, side);
      if (b <= a || b >= n) continue;
      double squared = 0;
      for (int axis = 0; axis < 3; ++axis)
        squared += std::pow(sites[a].centre[axis] - sites[b].centre[axis], 2);
      pairs.emplace_back(squared, a, b);
    }
  }
  std::sort(pairs.begin(), pairs.end());
  std::vector<std::pair<int, int>> result;
  for (const auto& [squared, a, b] : pairs) result.emplace_back(a, b);
  return result;
}

}  // namespace

BodyGraph synthetic_pile(int bodies, std::span<const double> mass_kg, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  const int side = static_cast<int>(std::ceil(std::cbrt(bodies)));
  const std::vector<Site> sites = settle(bodies, side, random);
  std::vector<std::pair<int, int>> pairs = close_pairs(sites, side);
  pairs.resize(std::min(pairs.size(), static_cast<std::size_t>(std::lround(1.765 * bodies))));
  std::vector<ConstraintLink> links;
  for (const auto& [a, b] : pairs) {
    const int points = 1 + static_cast<int>(random() % 8);
    for (int p = 0; p < points; ++p) links.push_back({a, b, 3});
  }
  std::vector<double> masses(bodies), positions;
  for (double& mass : masses) mass = mass_kg[random() % mass_kg.size()];
  for (const Site& site : sites) positions.insert(positions.end(), site.centre.begin(), site.centre.end());
  return BodyGraph(masses, links, std::nullopt, positions);
}

}  // namespace cleave
