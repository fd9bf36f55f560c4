// Chunks: what one task of a stage works on, about as many rows or bodies as take some microseconds. Chunks
// depend on the problem alone, never on the number of threads.
#pragma once

#include <vector>

namespace cleave {

struct Chunk {
  int first = 0, last = 0;  // groups of rows, bodies or domains: first .. last - 1
};

// Rows of a chunk at least; what chunks of so many gain on two threads stands at SolveState::run_over_rows.
constexpr int kLeastChunkRows = 384;

// Ranges of whole items with at least `least` of what size_of(item) counts, but for the last.
template <class Size>
void cut_into_chunks(int count, int least, const Size& size_of, std::vector<Chunk>& chunks) {
  chunks.clear();
  int size = 0;
  for (int i = 0, first = 0; i < count; ++i) {
    size += size_of(i);
    if (size < least && i + 1 < count) continue;
    chunks.push_back({first, i + 1});
    first = i + 1;
    size = 0;
  }
}

}  // namespace cleave
