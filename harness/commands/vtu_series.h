// cleave export --format vtu --out NAME.pvd: pictures of the steps of one simulation, NAME_0.vtu and so on,
// and their list.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace cleave {

// All appear together, the list last, or none where it is interrupted: a picture lies aside until the last is
// made. With force also the pictures of a longer series of this name go. Returns the exit code. Throws
// std::invalid_argument naming the file that is no later step of the same scene than the one before it, and
// what exists where nothing is forced; std::runtime_error of whole_file.h.
int write_vtu_series(const std::vector<std::string>& files, const std::filesystem::path& out, bool force);

}  // namespace cleave
