// Which dense kernel the interface systems run on, and how fast it is here: the one number that explains most
// of the difference between two machines.
#pragma once

#include <string>

namespace cleave {

std::string dense_instruction_set();  // the instruction set of its tiles: AVX2 or AVX-512

// Cholesky factorisation of 512 rows by one thread, best of three; takes about 10 ms.
double dense_gflop_per_s();

}  // namespace cleave
