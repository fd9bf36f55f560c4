// `cleave run --record-motion`: motion.h5, everything that is needed to replay a run as a picture.
//
// n bodies, s steps, k measured steps, c combinations. Poses and edges are those at the start of a step,
// which is what its problem was built from. Root attributes: schema, run_id, scene, seed, h_s (step in s),
// steps (asked for; an interrupted run has fewer), measure_every and combinations
// ("mindp+none+schur,mindp+kl+schur", c of them).
//
//     shape/          as in a problem file: what bodies look like, with world poses at the first step
//     mass            (n) kg
//     step            (s) int32
//     position        (s,n,3) float32, m
//     orientation     (s,n,4) float32, quaternion w x y z
//     measured/
//       step          (k) int32
//       island        (k,n) uint16, numbered by lowest body
//       edge_count    (k) int32
//       edge          (sum of edge_count, 2) uint16: body pairs of the constraint graph, step after step
//       part          (k,c,n) uint16; 65535: the solver ignores parts
//       interface     (k,c,n) uint8; 1: a constraint joins the body to another part
//       residual_m_per_s     (k,c,n) float32: largest residual of the rows at the body (solver/residual.h)
//       largest_impulse_n_s  (k,c,n) float32: largest |impulse| of these rows
//       t_s_ms, t_pr_ms      (k,c) float32, NaN where not measured
//       interface_rows       (k,c) int32, -1 where not measured
//       ok                   (k,c) uint8; 1: solved and within the judge's limit
//
// Residuals and impulses keep 11 significant bits, which is plenty for a colour and halves their size. The
// file grows every 16 steps and can be read then, and after the run was killed, in HDF5's SWMR mode
// (hdf5_series.h); the arrays may then have more entries than `step` and measured/step, which count.
//
// Size: about 17 bytes a body and step, and 1.5 to 2.5 more for every combination that measured it. 500 steps
// of 600 boxes, 50 of them measured with 6 combinations, are 5.7 MB.
#pragma once

#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "harness/combination.h"
#include "harness/ode_world.h"
#include "harness/options.h"
#include "harness/step_record.h"
#include "solver/step_problem.h"

namespace cleave {

class MotionRecorder {
 public:
  // Creates nothing on disk.
  MotionRecorder(std::filesystem::path path, const RunOptions& options);
  ~MotionRecorder();

  // One step before the world is advanced. rows and outcomes: one a combination on a measured step, else
  // empty. The first call creates the file. Throws std::runtime_error when it cannot be written, and
  // std::invalid_argument for more than 65535 bodies.
  void record(const OdeWorld& world, const StepProblem& problem, int step, std::span<const StepRecord> rows,
              std::span<const Outcome> outcomes);

  // Writes what is left and closes the file.
  void finish();

 private:
  class File;

  std::filesystem::path path_;
  RunOptions options_;
  std::vector<std::string> labels_;  // of the combinations
  std::unique_ptr<File> file_;
  int waiting_steps_ = 0;
};

}  // namespace cleave
