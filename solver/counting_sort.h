#pragma once

#include <numeric>
#include <vector>

namespace cleave {

// Items 0 .. item_count - 1 by bucket, ascending within each: those of bucket b at items[first[b]] ..
// items[first[b + 1] - 1]. bucket_of(item): 0 .. bucket_count - 1, or -1 for one that is left out. Buffers
// are kept.
template <class BucketOf>
void sort_into_buckets(int item_count, int bucket_count, const BucketOf& bucket_of, std::vector<int>& first,
                       std::vector<int>& items) {
  // One place further on while buckets are filled: there each one's end moves to where the next one begins.
  first.assign(bucket_count + 2, 0);
  for (int item = 0; item < item_count; ++item) {
    if (const int bucket = bucket_of(item); bucket >= 0) ++first[bucket + 2];
  }
  std::partial_sum(first.begin(), first.end(), first.begin());
  items.resize(first.back());
  for (int item = 0; item < item_count; ++item) {
    if (const int bucket = bucket_of(item); bucket >= 0) items[first[bucket + 1]++] = item;
  }
  first.pop_back();
}

}  // namespace cleave
