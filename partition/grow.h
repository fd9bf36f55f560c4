// The one growing loop of the paper's partitioners (Liu & Andrews 2022, section 3.1).
//
// G0 = the bodies that are in no part yet, at first all. While G0 is not empty: open a part with a seed from
// G0, then add one body of G0 adjacent to the part at a time, until the part has max_bodies bodies or no such
// body is wanted; close it. So parts are contiguous, and part ids are the order of creation. The paper prints
// the outer condition of its Algorithm 1 as size(G0) < n_max, which would stop before anything is grown; it
// is read as "G0 is not empty".
//
// Such a partitioner is a chooser: it names the seed and the next body. A body leaves G0 the moment it joins
// the open part.
#pragma once

#include <cstdint>
#include <vector>

#include "partition/body_graph.h"
#include "partition/partition.h"

namespace cleave {

// What a chooser may look at while parts grow.
struct Growth {
  const BodyGraph& graph;
  Partition partition;  // part_of_body is -1 for bodies in G0
  int open_bodies = 0;  // bodies of the open part

  bool is_left(int body) const { return partition.part_of_body[body] < 0; }
  // The lowest body of G0 from this one on; there must be one.
  int lowest_left(int body) const {
    while (!is_left(body)) ++body;
    return body;
  }
  int open_part() const { return partition.part_count - 1; }
};

class Chooser {
 public:
  virtual ~Chooser() = default;

  // The first body of the part that was just opened; must be in G0, which is not empty.
  virtual int seed(const Growth& growth) = 0;
  // A body of G0 adjacent to the open part, or -1 to close the part.
  virtual int next(const Growth& growth) = 0;
  // The body has joined the open part and left G0.
  virtual void joined(const Growth& growth, int body) = 0;
};

Partition grow(const BodyGraph& graph, int max_bodies, Chooser& chooser);

// Bodies by (key, index), lowest first. An entry is never changed: a body whose key changes is pushed again,
// and whoever pops skips entries that no longer tell the truth. push and pop take O(log entries).
class BodyHeap {
 public:
  struct Entry {
    int key;
    int body;
  };

  bool empty() const { return entries_.empty(); }
  void clear() { entries_.clear(); }
  void reserve(int entries) { entries_.reserve(entries); }
  void push(int key, int body);
  Entry pop();

 private:
  std::vector<std::uint64_t> entries_;  // key and body in one word that sorts as the pair does
};

}  // namespace cleave
