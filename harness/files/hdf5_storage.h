// Where the data of a dataset lie and how much they ask for, looked at before they are read.
#pragma once

#include <cstdint>
#include <string>

#include "harness/files/hdf5_handle.h"

namespace cleave {

// Empty where all data are in the file itself, by filters that every reader has, and no more than it can
// hold; else one line without the file: "storage of rhs = another file, allowed: this file". name: with its
// groups.
std::string find_storage_error(const Hdf5Handle& dataset, const std::string& name, std::uintmax_t file_bytes);

}  // namespace cleave
