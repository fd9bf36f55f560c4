#include "harness/campaign/cell_times.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace cleave {
namespace {

std::string kind_of(const CampaignCell& cell) {
  std::string kind;
  for (const auto& [name, value] : cell.options)
    if (name != "seed") kind.append(name).append("=").append(value).append("\n");
  return kind;
}

}  // namespace

void CellTimes::add(const CampaignCell& cell, double seconds) {
  if (std::isnan(seconds)) return;
  for (Mean* mean : {&of_kind_[kind_of(cell)], &of_scene_[cell.options.at("scene")], &all_}) {
    mean->sum += seconds;
    ++mean->count;
  }
}

void CellTimes::add_running(const CampaignCell& cell, double seconds, std::optional<double> expects_s) {
  if (expects_s) return add(cell, std::max(*expects_s, seconds));
  const std::optional<double> expected = of(cell);
  if (expected && *expected < seconds) add(cell, 2 * seconds);
}

std::optional<double> CellTimes::of(const CampaignCell& cell) const {
  const auto mean = [](const Mean& of) { return of.sum / of.count; };
  if (const auto kind = of_kind_.find(kind_of(cell)); kind != of_kind_.end()) return mean(kind->second);
  if (const auto scene = of_scene_.find(cell.options.at("scene")); scene != of_scene_.end())
    return mean(scene->second);
  return all_.count > 0 ? std::optional(mean(all_)) : std::nullopt;
}

std::string seconds_text(double seconds) {
  char text[40];
  std::snprintf(text, sizeof text, "%.0f s", seconds);
  return text;
}

}  // namespace cleave
