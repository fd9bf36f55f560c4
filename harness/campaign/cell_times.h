// How long cells that are still to be run will take, from those that have.
#pragma once

#include <map>
#include <optional>
#include <string>

#include "harness/campaign/spec.h"

namespace cleave {

// A cell takes as long as the mean of finished cells of its kind, which are those whose options differ from
// its own in the seed alone; where there is none, as the mean of those of its scene; else as that of all.
class CellTimes {
 public:
  void add(const CampaignCell& cell, double seconds);
  // A cell that runs: as long as it expects itself; where it has not said, and runs longer than was expected
  // of it, it is taken to be half done.
  void add_running(const CampaignCell& cell, double seconds, std::optional<double> expects_s);
  // Nothing before the first has finished, or has said what it expects.
  std::optional<double> of(const CampaignCell& cell) const;

 private:
  struct Mean {
    double sum = 0;
    int count = 0;
  };
  std::map<std::string, Mean> of_kind_, of_scene_;
  Mean all_;
};

// "12 s", of any number of seconds without its fractions.
std::string seconds_text(double seconds);

}  // namespace cleave
