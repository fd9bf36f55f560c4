// The kernel of the table that has this name, with its parameters as they are by default.
#pragma once

#include <memory>
#include <stdexcept>
#include <string>

#include "solver/kernels/kernel.h"
#include "solver/registry.h"

namespace cleave {

inline std::unique_ptr<Kernel> make_kernel(const std::string& name) {
  for (const KernelRow& row : kernel_table())
    if (name == row.name) return row.make(defaults_of(row));
  throw std::logic_error(name);
}

}  // namespace cleave
