// The coefficients of the cost model (cost_model.h) on one machine, as text that `cleave calibrate` writes:
//
//     schema = "cleave-calibration-4"          first lines: name = "text", kept as they are
//     [schur-rows.threads-1]                   a kernel on so many threads
//     factorizations_most = 6                  then a line for each number of KernelCost
//
// in the form of TOML. A calibration is known by its fingerprint, FNV-1a-64 over the bytes of the text, so
// that what was chosen by it depends on nothing that is not on record. The one that is shipped
// (calibration.toml) is always known to a process; others are once their file was read.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "harness/base/parameter.h"
#include "partition/cost_model.h"

namespace cleave {

struct Calibration {
  std::string fingerprint;  // 16 hexadecimal digits
  std::vector<KernelCost> kernels;

  // On more threads than were calibrated the costs are those of the most that were. Throws
  // std::invalid_argument for a kernel that it has not.
  KernelCost of(CostKernel kernel, int threads) const;
};

// about: name and text of the first lines after the schema.
std::string calibration_text(const std::vector<std::pair<std::string, std::string>>& about,
                             const std::vector<KernelCost>& kernels);

// source: what errors begin with. Throws std::invalid_argument naming the line, what it holds and what is
// allowed.
Calibration parse_calibration(const std::string& source, const std::string& text);

// text: `shipped`, the fingerprint of one that is known, or a file, which is read and then known. Returns the
// fingerprint. A text of 16 hexadecimal digits is taken for a fingerprint and looked up when it is used, so
// that what is stored can be named. Throws std::invalid_argument beginning with `option`.
std::string read_calibration(const std::string& option, const std::string& text);

// Throws std::invalid_argument for a fingerprint that nobody has read.
const Calibration& known_calibration(const std::string& fingerprint);
bool is_known_calibration(const std::string& fingerprint);

// What the parameters calibration, cost-kernel and cost-threads say together: one kernel, or those of
// cost_kernel_names where cost-kernel is `any`. Throws as known_calibration and Calibration::of.
std::vector<KernelCost> kernel_costs(const Settings& settings);

// For who models one kernel: throws std::invalid_argument where cost-kernel is `any`.
KernelCost kernel_cost(const Settings& settings);

}  // namespace cleave
