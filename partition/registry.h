// The tables of partitioners and refiners: command-line choices, `cleave list`, error texts and the contract
// tests all iterate these tables.
#pragma once

#include <memory>
#include <span>

#include "partition/partitioner.h"
#include "partition/refiner.h"

namespace cleave {

struct PartitionerEntry {
  const char* name;
  const char* help;       // one line
  const char* reference;  // where it is described
  std::unique_ptr<Partitioner> (*make)();
};

struct RefinerEntry {
  const char* name;
  const char* help;
  const char* reference;
  std::unique_ptr<Refiner> (*make)();
};

std::span<const PartitionerEntry> partitioners();
std::span<const RefinerEntry> refiners();

}  // namespace cleave
