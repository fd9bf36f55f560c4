// How fast one core multiplies and adds when nothing else is in the way: fused multiply-adds on registers, in
// as many independent chains as hide their latency.
#pragma once

namespace cleave {

// Runs `rounds` rounds of multiply-adds with the instructions of DenseTiles::name and returns the
// floating-point operations they are. Throws std::invalid_argument for a name it does not know.
double run_multiply_adds(const char* instruction_set, int rounds);

}  // namespace cleave
