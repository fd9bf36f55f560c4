// motion.h5 of `cleave run --record-motion`: everything that is needed to replay a run as a picture.
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
// file grows every 16 steps under the name motion.h5.part and gets its own when the run ends, or is
// interrupted. A run that was killed, or met a full disk, leaves motion.h5.part: the first 16 steps or more
// of it, if it got so far, can be read in HDF5's SWMR mode (hdf5_series.h), as they can while the run goes
// on, and once it is renamed the viewer shows them; its arrays may have more entries than `step` and
// measured/step, which count.
//
// Size: about 17 bytes a body and step, and 1.5 to 2.5 more for every combination that measured it. 500 steps
// of 600 boxes, 50 of them measured with 6 combinations, are 5.7 MB.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "harness/base/shapes.h"

namespace cleave {

// What does not change over the steps.
struct MotionSetup {
  std::string run_id, scene;
  std::uint64_t seed = 0;
  double h_s = 0;
  int steps = 0, measure_every = 1;
  std::vector<std::string> labels;  // (c) of the combinations
  std::vector<double> mass_kg;      // (n)
  ProblemShapes shapes;             // at the first step
};

struct MotionPose {
  std::array<double, 3> position_m;
  std::array<double, 4> orientation;  // quaternion w x y z
};

struct MotionGraph {
  std::vector<std::uint16_t> island;               // (n)
  std::vector<std::array<std::uint16_t, 2>> edge;  // lower body first
};

// What one combination made of a measured step.
struct MotionSolution {
  std::vector<std::uint16_t> part;         // (n)
  std::vector<std::uint8_t> interface;     // (n)
  std::vector<float> residual_m_per_s;     // (n)
  std::vector<float> largest_impulse_n_s;  // (n)
  float t_s_ms, t_pr_ms;
  int interface_rows;
  bool ok;
};

inline constexpr int kMostMotionBodies = 65535;  // body numbers and part ids have 16 bits

class MotionFile {
 public:
  // Creates the file, under its part name (whole_file.h). Throws std::runtime_error when it cannot be
  // written, here and in the calls below.
  MotionFile(const std::filesystem::path& path, const MotionSetup& setup);
  ~MotionFile();

  void add_poses(int step, std::span<const MotionPose> poses);  // (n)
  void add_graph(int step, const MotionGraph& graph);
  void add_solution(const MotionSolution& solution);  // c after each graph, in the order of the labels

  // One step is whole: it goes to disk, at the latest with the fifteen that follow.
  void end_step();

  // The last call: the file is whole and gets its name.
  void publish();

 private:
  class Series;
  std::filesystem::path path_;
  std::unique_ptr<Series> series_;
  int waiting_steps_ = 0;
};

}  // namespace cleave
