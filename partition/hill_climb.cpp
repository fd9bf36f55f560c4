#include "partition/hill_climb.h"

namespace cleave {

long HillClimb::run() {
  moves_.clear();
  kept_ = 0;
  long fall = 0, most = 0;
  while (moves_.size() - kept_ < static_cast<std::size_t>(patience_)) {
    const std::optional<Exchange> move = search_.find();
    if (!move) break;
    moves_.push_back({move->first, partition_.part_of_body[move->first]});
    search_.lock(move->first);
    search_.make(*move);
    fall += move->gain;
    if (fall <= most) continue;
    most = fall;
    kept_ = moves_.size();
  }
  for (std::size_t k = moves_.size(); k > kept_; --k)
    search_.put_back(moves_[k - 1].body, moves_[k - 1].from);
  return most;
}

}  // namespace cleave
