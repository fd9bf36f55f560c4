#include "partition/move_search.h"

namespace cleave {

MoveSearch::MoveSearch(const BodyGraph& graph, EdgeWeight unit, int most_bodies, MoveKind kind,
                       Partition& partition, std::span<const char> stays)
    : graph_(graph),
      partition_(partition),
      most_bodies_(most_bodies),
      kind_(kind),
      gains_(graph, unit, partition.part_count),
      version_(graph.body_count(), 0),
      stays_(stays.begin(), stays.end()),
      parked_(partition.part_count) {
  stays_.resize(graph.body_count(), 0);
  restart();
}

void MoveSearch::restart() {
  bodies_ = part_sizes(partition_);
  is_locked_ = stays_;
  forget_moves();
  for (int i = 0; i < graph_.body_count(); ++i) push_moves(i);
}

void MoveSearch::restart_at(int body) {
  forget_moves();
  push_moves(body);
}

void MoveSearch::forget_moves() {
  for (const int part : parked_at_) parked_[part].clear();
  parked_at_.clear();
  moves_.clear();
}

void MoveSearch::push_moves(int body) {
  if (is_locked_[body]) return;
  for (const MoveGain& move : gains_.of(body, partition_.part_of_body)) {
    ++gains_counted_;
    if (kind_ == MoveKind::all || move.gain > 0) moves_.push({move.gain, body, move.part, version_[body]});
  }
}

// A blocked move can become possible only when the part that blocks it changes size: it waits there.
bool MoveSearch::park_if_blocked(const Exchange& move) {
  const int source = partition_.part_of_body[move.first];
  const int target = move.second;
  const int part = bodies_[target] >= most_bodies_ ? target : bodies_[source] == 1 ? source : -1;
  if (part < 0) return false;
  if (parked_[part].empty()) parked_at_.push_back(part);
  parked_[part].push_back(move);
  return true;
}

void MoveSearch::unpark(int part) {
  for (const Exchange& move : parked_[part]) {
    if (move.tag == version_[move.first]) moves_.push(move);
  }
  parked_[part].clear();
}

std::optional<Exchange> MoveSearch::find() {
  while (!moves_.empty()) {
    const Exchange move = moves_.pop();
    if (move.tag == version_[move.first] && !is_locked_[move.first] && !park_if_blocked(move)) return move;
  }
  return std::nullopt;
}

void MoveSearch::put_back(int body, int from) {
  --bodies_[partition_.part_of_body[body]];
  ++bodies_[from];
  partition_.part_of_body[body] = from;
}

void MoveSearch::make(const Exchange& move) {
  const int body = move.first;
  const int source = partition_.part_of_body[body];
  partition_.part_of_body[body] = move.second;
  --bodies_[source];
  ++bodies_[move.second];
  ++version_[body];
  push_moves(body);
  for (int other : graph_.neighbours(body)) {
    ++version_[other];
    push_moves(other);
  }
  unpark(source);
  unpark(move.second);
}

}  // namespace cleave
