// A problem in the global form of FCLIB, the library of friction contact problems (Acary, Brémond, Koziara
// and Pérignon, INRIA RT-0444, 2014), in the HDF5 layout of its version 3.1. N unknowns, K columns of
// contacts, P of joints:
//
//     M v = H r + G l + f        G^T v + b = 0        u = H^T v + w
//
// and for every contact, whose columns are its normal and its one or two tangents, with mu its coefficient,
//
//     |r_t| <= mu r_n,    u_n >= 0,    (u_n + mu |u_t|) r_n + u_t . r_t = 0        (Coulomb's law).
//
//     fclib_global/spacedim                     2 or 3, the columns of a contact
//     fclib_global/M, /H, /G                    groups of m, n (rows and columns), nz, nzmax, p, i, x;
//                                               G may be missing
//     fclib_global/vectors/f, w, mu, b          (N), (K), (K / spacedim), (P); b where there is a G
//
// nz = -1: p says where a column begins in i, its rows, and x, its values; nz = -2: the same by rows; nz >=
// 0: triplets. Of triplets fclib.h says that p are rows and i columns, and Siconos, which has them from
// CSparse, writes columns and rows: what fits the shape is taken, and where both do, the matrix is refused. M
// is symmetric and reads the same. Columns are written.
//
// Two attributes of fclib_global are ours: `cleave_bodies`, the bodies whose unknowns come first, six each,
// before those of springs (fclib_problem.h), and `cleave_h_s`, the step.
#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "harness/files/matrix_entries.h"

namespace cleave {

struct FclibMatrix {
  int rows = 0, columns = 0;
  std::vector<MatrixEntry> entries;  // as sum_entries leaves them
};

struct FclibGlobal {
  int dimension = 3;       // columns of a contact
  FclibMatrix M, H, G;     // (N, N), (N, K), (N, P)
  std::vector<double> f;   // (N)
  std::vector<double> w;   // (K)
  std::vector<double> mu;  // (K / dimension)
  std::vector<double> b;   // (P)
  std::optional<int> bodies;
  std::optional<double> h_s;
};

// Throws std::invalid_argument with one line that begins with the file: what Hdf5Reader and read_in_child
// say, the local form, another spacedim, matrices that do not fit together or name places that they have not,
// numbers that are not finite.
FclibGlobal read_fclib_file(const std::filesystem::path& path);

// Throws std::runtime_error as Hdf5Writer does.
void write_fclib_file(const std::filesystem::path& path, const FclibGlobal& problem);

}  // namespace cleave
