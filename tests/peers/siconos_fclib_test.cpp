// What is exported for FCLIB, read back by the library of FCLIB's own, is a problem of Siconos whose solution
// is ours. (Debian's Siconos is built without its own reader of these files, which calls the same library.)
#include <gtest/gtest.h>
#include <numerics/Friction_cst.h>
#include <numerics/GlobalFrictionContactProblem.h>
#include <numerics/NonSmoothDrivers.h>
#include <numerics/NumericsMatrix.h>
#include <numerics/NumericsSparseMatrix.h>
#include <numerics/SolverOptions.h>

#include <cstdlib>
#include <filesystem>
#include <memory>

extern "C" {  // the header does not say so itself
#include <fclib.h>
}

#include "harness/files/fclib_problem.h"
#include "solver/registry.h"
#include "tests/harness/run_program.h"
#include "tests/peers/coulomb_problems.h"
#include "tests/solver/solver_checks.h"

namespace cleave {
namespace {

struct DeleteOptions {
  void operator()(SolverOptions* options) const { solver_options_delete(options); }
};
struct DeleteGlobal {
  void operator()(fclib_global* global) const {
    fclib_delete_global(global);
    free(global);
  }
};

// Columns one after another, as they are exported.
NumericsMatrix* matrix_of(const fclib_matrix& from) {
  EXPECT_EQ(from.nz, -1);
  NumericsMatrix* matrix = NM_create(NM_SPARSE, from.m, from.n);
  NM_triplet_alloc(matrix, from.nzmax);
  matrix->matrix2->origin = NSM_TRIPLET;
  for (int column = 0; column < from.n; ++column)
    for (int entry = from.p[column]; entry < from.p[column + 1]; ++entry)
      NM_entry(matrix, from.i[entry], column, from.x[entry]);
  return matrix;
}

// Velocities of all unknowns, those of bodies first.
std::vector<double> solved_by_siconos(fclib_global& global) {
  GlobalFrictionContactProblem problem{};
  problem.dimension = global.spacedim;
  problem.numberOfContacts = global.H->n / global.spacedim;
  problem.M = matrix_of(*global.M);
  problem.H = matrix_of(*global.H);
  problem.q = global.f;
  problem.b = global.w;
  problem.mu = global.mu;
  const std::unique_ptr<SolverOptions, DeleteOptions> options(
      solver_options_create(SICONOS_GLOBAL_FRICTION_3D_NSGS_WR));
  options->dparam[SICONOS_DPARAM_TOL] = 1e-11;
  options->iparam[SICONOS_IPARAM_MAX_ITER] = 100000;
  std::vector<double> reaction(global.H->n), velocity(global.H->n), unknowns(global.M->n);
  EXPECT_EQ(gfc3d_driver(&problem, reaction.data(), velocity.data(), unknowns.data(), options.get()), 0);
  NM_free(problem.M);
  NM_free(problem.H);
  return unknowns;
}

TEST(SiconosFclib, AnExportedProblemHasTheSameSolutionThere) {
  const TemporaryDirectory directory;
  for (const int seed : {1, 2, 3}) {
    const StepProblem pile =
        with_coulomb(make_pile(seed, {.columns = 2, .rows = 1, .layers = 2, .cfm = 1e-4, .mu = 0.3}));
    Solution ours = cold_start(pile);
    const SolveSummary summary = make_step_solver("exact")->solve(pile, {}, ours);
    ASSERT_TRUE(is_exact(pile, summary, ours)) << seed;
    const std::filesystem::path path = directory / ("pile" + std::to_string(seed) + ".hdf5");
    write_fclib_file(path, fclib_of_problem(pile));
    const std::unique_ptr<fclib_global, DeleteGlobal> global(fclib_read_global(path.c_str()));
    ASSERT_NE(global, nullptr);
    ASSERT_EQ(global->G, nullptr);
    const std::vector<double> theirs = solved_by_siconos(*global);
    ASSERT_GE(theirs.size(), ours.velocity.size());
    for (std::size_t k = 0; k < ours.velocity.size(); ++k)
      EXPECT_NEAR(theirs[k], ours.velocity[k], 1e-7) << seed << ", " << k;
  }
}

}  // namespace
}  // namespace cleave
