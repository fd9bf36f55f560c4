// The arrays of an FCLIB file as they lie in it, and whether they are a problem.
#pragma once

#include <vector>

#include "harness/files/fclib_file.h"

namespace cleave {

inline constexpr int kFclibColumns = -1, kFclibRows = -2;  // nz of compressed matrices

struct StoredFclibMatrix {
  int m = 0, n = 0, nz = kFclibColumns, nzmax = 0;
  std::vector<int> p, i;
  std::vector<double> x;
};

struct StoredFclib {
  StoredFclibMatrix M, H, G;
  FclibGlobal rest;  // all but its matrices
};

// Throws std::invalid_argument with one line, without the file.
FclibGlobal checked_fclib(const StoredFclib& stored);

}  // namespace cleave
