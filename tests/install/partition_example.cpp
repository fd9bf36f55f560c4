// Splits a wall of 4 x 6 boxes into parts of at most 8 and prints the part of every box.
#include <cstdio>
#include <vector>

#include "partition/partition.h"
#include "partition/registry.h"

int main() {
  constexpr int kColumns = 6, kRows = 4, kMaxBodies = 8;
  const std::vector<double> mass_kg(kColumns * kRows, 1.0);
  std::vector<cleave::ConstraintLink> links;  // four contact points of three rows each where boxes touch
  for (int body = 0; body < kColumns * kRows; ++body) {
    for (int point = 0; point < 4; ++point) {
      if (body % kColumns + 1 < kColumns) links.push_back({body, body + 1, 3});
      if (body / kColumns + 1 < kRows) links.push_back({body, body + kColumns, 3});
    }
  }
  const cleave::BodyGraph graph(mass_kg, links);

  cleave::Partition partition = cleave::make_partitioner("mindp@max-bodies=8")->run(graph);
  cleave::make_refiner("fm")->run(graph, kMaxBodies, partition);

  for (int body = 0; body < graph.body_count(); ++body)
    std::printf("%d%c", partition.part_of_body[body], body % kColumns + 1 < kColumns ? ' ' : '\n');
  const cleave::PartitionMetrics metrics = cleave::measure_partition(graph, partition.part_of_body);
  std::printf("%d parts, %d interface rows\n", metrics.parts, metrics.interface_rows);
}
