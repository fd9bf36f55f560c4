// The one name of a (partitioner, refiner, solver) in files and pictures.
#pragma once

#include <string>

namespace cleave {

// "mix+fm+schur"; "-+-+monolithic" for a solver that ignores parts.
inline std::string combination_label(const std::string& partitioner, const std::string& refiner,
                                     const std::string& solver) {
  return partitioner + "+" + refiner + "+" + solver;
}

}  // namespace cleave
