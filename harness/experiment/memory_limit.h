// How much memory the machine has for factorisations.
#pragma once

#include <cstdint>
#include <filesystem>

namespace cleave {

// The least of what the machine has available, what control groups (version 2) leave of theirs, and, of this
// process, what its limit of address space leaves. kNoMemoryLimit where the system says none of these. root:
// where /proc and /sys are.
std::uint64_t available_memory_bytes(const std::filesystem::path& root = "/");

// What factorisations may take: given, in 1e9 bytes, or, where that is NaN, nine tenths of what is available;
// the tenth is for what else a solve needs.
std::uint64_t memory_limit_bytes(double given_gb);

}  // namespace cleave
