#include "harness/files/motion_file.h"

#include <algorithm>
#include <utility>

#include "harness/base/names.h"
#include "harness/files/hdf5_series.h"
#include "harness/files/problem_file_fields.h"
#include "harness/files/whole_file.h"

namespace cleave {
namespace {

constexpr int kSyncSteps = 16;  // also the entries of a chunk, which is then written once
constexpr std::size_t kChunkEdges = 4096;

template <std::size_t N>
std::array<float, N> to_float(const std::array<double, N>& values) {
  std::array<float, N> rounded;
  std::ranges::transform(values, rounded.begin(), [](double value) { return static_cast<float>(value); });
  return rounded;
}

void write_setup(const Hdf5Writer& root, const MotionSetup& setup) {
  root.attribute("schema", std::string("cleave-motion-1"));
  root.attribute("run_id", setup.run_id);
  root.attribute("scene", setup.scene);
  root.attribute("seed", setup.seed);
  root.attribute("h_s", setup.h_s);
  root.attribute("steps", setup.steps);
  root.attribute("measure_every", setup.measure_every);
  root.attribute("combinations", joined(setup.labels, ","));
  root.array("mass", {setup.mass_kg.size()}, setup.mass_kg);

  const Hdf5Writer group = root.group("shape");
  visit_shape_arrays(setup.shapes, setup.shapes.geom_body.size(), setup.shapes.convex_points.size() / 3,
                     [&](const char* name, const auto& values, const Hdf5Shape& shape) {
                       group.array(name, shape, values);
                     });
}

}  // namespace

// The open file and its growing arrays.
class MotionFile::Series {
 public:
  Series(const std::filesystem::path& path, const MotionSetup& setup)
      : file_(path),
        n_(setup.mass_kg.size()),
        c_(setup.labels.size()),
        chunk_(setup.measure_every == 1 ? kSyncSteps : 1) {
    write_setup(file_.root(), setup);
    file_.start();
  }

  void add_poses(int step, std::span<const MotionPose> poses) {
    for (const MotionPose& pose : poses) {
      position_.append(to_float(pose.position_m));
      orientation_.append(to_float(pose.orientation));
    }
    step_.append(step);
  }

  void add_graph(int step, const MotionGraph& graph) {
    island_.append(graph.island);
    for (const auto& edge : graph.edge) edge_.append(edge);
    edge_count_.append(static_cast<int>(graph.edge.size()));
    measured_step_.append(step);
  }

  void add_solution(const MotionSolution& solution) {
    part_.append(solution.part);
    interface_.append(solution.interface);
    residual_.append(solution.residual_m_per_s);
    largest_impulse_.append(solution.largest_impulse_n_s);
    t_s_ms_.append(solution.t_s_ms);
    t_pr_ms_.append(solution.t_pr_ms);
    interface_rows_.append(solution.interface_rows);
    ok_.append(solution.ok);
  }

  // `step` and measured/step say how many entries are complete, so they come last.
  void sync() {
    for (Hdf5Series* series : all()) series->sync();
  }

  void close() {
    sync();
    for (Hdf5Series* series : all()) series->close();
    file_.close();
  }

 private:
  std::array<Hdf5Series*, 15> all() {
    return {&position_, &orientation_,    &island_,   &edge_count_,      &edge_,
            &part_,     &interface_,      &residual_, &largest_impulse_, &t_s_ms_,
            &t_pr_ms_,  &interface_rows_, &ok_,       &measured_step_,   &step_};
  }

  Hdf5SeriesFile file_;
  std::size_t n_, c_, chunk_;
  Hdf5SeriesOf<float> position_{file_, "position", {n_, 3}, kSyncSteps};
  Hdf5SeriesOf<float> orientation_{file_, "orientation", {n_, 4}, kSyncSteps};
  Hdf5SeriesOf<std::uint16_t> island_{file_, "measured/island", {n_}, chunk_};
  Hdf5SeriesOf<int> edge_count_{file_, "measured/edge_count", {}, kSyncSteps};
  Hdf5SeriesOf<std::uint16_t> edge_{file_, "measured/edge", {2}, kChunkEdges};
  Hdf5SeriesOf<std::uint16_t> part_{file_, "measured/part", {c_, n_}, chunk_};
  Hdf5SeriesOf<std::uint8_t> interface_{file_, "measured/interface", {c_, n_}, chunk_};
  Hdf5SeriesOf<float> residual_{file_, "measured/residual_m_per_s", {c_, n_}, chunk_};
  Hdf5SeriesOf<float> largest_impulse_{file_, "measured/largest_impulse_n_s", {c_, n_}, chunk_};
  Hdf5SeriesOf<float> t_s_ms_{file_, "measured/t_s_ms", {c_}, kSyncSteps};
  Hdf5SeriesOf<float> t_pr_ms_{file_, "measured/t_pr_ms", {c_}, kSyncSteps};
  Hdf5SeriesOf<int> interface_rows_{file_, "measured/interface_rows", {c_}, kSyncSteps};
  Hdf5SeriesOf<std::uint8_t> ok_{file_, "measured/ok", {c_}, kSyncSteps};
  Hdf5SeriesOf<int> measured_step_{file_, "measured/step", {}, kSyncSteps};
  Hdf5SeriesOf<int> step_{file_, "step", {}, kSyncSteps};
};

MotionFile::MotionFile(const std::filesystem::path& path, const MotionSetup& setup)
    : path_(path), series_(std::make_unique<Series>(part_name_of(path), setup)) {}
MotionFile::~MotionFile() = default;

void MotionFile::add_poses(int step, std::span<const MotionPose> poses) { series_->add_poses(step, poses); }
void MotionFile::add_graph(int step, const MotionGraph& graph) { series_->add_graph(step, graph); }
void MotionFile::add_solution(const MotionSolution& solution) { series_->add_solution(solution); }

void MotionFile::end_step() {
  if (++waiting_steps_ < kSyncSteps) return;
  series_->sync();
  waiting_steps_ = 0;
}

void MotionFile::publish() {
  series_->close();
  series_.reset();
  publish_part_file(path_);
}

}  // namespace cleave
