// The tables of partitioners and refiners: command-line choices, `cleave list`, error texts and the contract
// tests all iterate these tables.
#pragma once

#include <memory>
#include <span>
#include <string>

#include "harness/base/algorithm.h"
#include "partition/partitioner.h"
#include "partition/refiner.h"

namespace cleave {

struct PartitionerTraits {
  bool of_paper = false;       // one of Liu & Andrews 2022: what --partitioner paper names
  bool needs_groups = false;   // of bodies, which not every scene names
  bool makes_choices = false;  // Partition::choice, with a kernel
  // What is left of the promise with these settings; null: all of it.
  PartsPromise (*promise_with)(const PartsPromise& promise, const Settings& settings) = nullptr;
};

struct PartitionerEntry : AlgorithmEntry {
  PartsPromise promise;
  std::unique_ptr<Partitioner> (*make)(const Settings& settings);  // null: unavailable
  PartitionerTraits traits = {};
};

struct RefinerTraits {
  bool of_paper = false;
  bool may_raise_cut = false;  // its objective is another
};

struct RefinerEntry : AlgorithmEntry {
  std::unique_ptr<Refiner> (*make)(const Settings& settings);
  RefinerTraits traits = {};
};

std::span<const PartitionerEntry> partitioners();
std::span<const RefinerEntry> refiners();

// Throws std::invalid_argument with one line for a name that is in no row.
const PartitionerEntry& partitioner_row(const std::string& name);

// "mix@tau-mix=0.3": the algorithm with these parameters and the defaults of all others. Throw
// std::invalid_argument with one line that names the text and what is allowed.
Algorithm read_partitioner(const std::string& text);
Algorithm read_refiner(const std::string& text);

// Made at once.
std::unique_ptr<Partitioner> make_partitioner(const std::string& text);
std::unique_ptr<Refiner> make_refiner(const std::string& text);

// The same from complete settings; the name must be in the table.
std::unique_ptr<Partitioner> make_partitioner(const Algorithm& algorithm);
std::unique_ptr<Refiner> make_refiner(const Algorithm& algorithm);

}  // namespace cleave
