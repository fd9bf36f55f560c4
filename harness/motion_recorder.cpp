#include "harness/motion_recorder.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <stdexcept>
#include <utility>

#include "harness/body_marks.h"
#include "harness/extract_shapes.h"
#include "harness/hash.h"
#include "harness/hdf5_series.h"
#include "harness/nearest_name.h"
#include "harness/problem_file.h"
#include "harness/problem_file_fields.h"
#include "harness/problem_graph.h"

namespace cleave {
namespace {

constexpr int kSyncSteps = 16;  // also the entries of a chunk, which is then written once
constexpr std::size_t kChunkEdges = 4096;
constexpr int kMostBodies = kNoPart;  // body numbers and part ids have 16 bits

template <std::size_t N>
std::array<float, N> to_float(const std::array<double, N>& values) {
  std::array<float, N> rounded;
  std::ranges::transform(values, rounded.begin(), [](double value) { return static_cast<float>(value); });
  return rounded;
}

std::vector<double> masses_kg(const StepProblem& problem) {
  std::vector<double> masses(problem.body_count());
  for (int i = 0; i < problem.body_count(); ++i) masses[i] = problem.mass[36 * i];
  return masses;
}

void write_fixed_part(const Hdf5Writer& root, const OdeWorld& world, const StepProblem& problem,
                      const RunOptions& options, const std::vector<std::string>& labels) {
  root.attribute("schema", std::string("cleave-motion-1"));
  root.attribute("run_id", run_id(options));
  root.attribute("scene", options.scene);
  root.attribute("seed", options.seed);
  root.attribute("h_s", problem.h_s);
  root.attribute("steps", options.steps);
  root.attribute("measure_every", options.measure_every);
  root.attribute("combinations", joined(labels, ","));
  root.array("mass", {static_cast<std::size_t>(problem.body_count())}, masses_kg(problem));

  const ProblemShapes shapes = extract_shapes(world);
  const Hdf5Writer group = root.group("shape");
  visit_shape_arrays(shapes, shapes.geom_body.size(), shapes.convex_points.size() / 3,
                     [&](const char* name, const auto& values, const Hdf5Shape& shape) {
                       group.array(name, shape, values);
                     });
}

}  // namespace

// The open file and its series.
class MotionRecorder::File {
 public:
  File(const std::filesystem::path& path, const OdeWorld& world, const StepProblem& problem,
       const RunOptions& options, const std::vector<std::string>& labels)
      : file_(path),
        n_(problem.body_count()),
        c_(labels.size()),
        chunk_(options.measure_every == 1 ? kSyncSteps : 1) {
    write_fixed_part(file_.root(), world, problem, options, labels);
    file_.start();
  }

  void add_poses(const OdeWorld& world, int step) {
    for (int i = 0; i < world.body_count(); ++i) {
      const BodyState state = world.state(i);
      position_.append(to_float(state.position_m));
      orientation_.append(to_float(state.orientation));
    }
    step_.append(step);
  }

  void add_graph(const BodyGraph& graph, int step) {
    std::vector<int> islands;
    count_islands(graph, &islands);
    for (const int id : islands) island_.append(static_cast<std::uint16_t>(id));
    for (int i = 0; i < graph.body_count(); ++i) {
      for (const int other : graph.neighbours(i)) {
        if (i < other)
          edge_.append(std::array{static_cast<std::uint16_t>(i), static_cast<std::uint16_t>(other)});
      }
    }
    edge_count_.append(graph.edge_count());
    measured_step_.append(step);
  }

  void add_solution(const StepProblem& problem, const BodyGraph& graph, const StepRecord& row,
                    const Outcome& outcome) {
    const BodyMarks marks = mark_bodies(problem, graph, outcome.part_of_body, outcome.solution.impulse);
    part_.append(marks.part);
    interface_.append(marks.interface);
    residual_.append(marks.residual_m_per_s);
    largest_impulse_.append(marks.largest_impulse_n_s);
    t_s_ms_.append(static_cast<float>(row.t_s_ms));
    t_pr_ms_.append(static_cast<float>(row.t_pr_ms));
    interface_rows_.append(row.interface_rows);
    ok_.append(row.status == to_string(SolveStatus::ok));
  }

  // `step` and measured/step say how many entries are complete, so they come last.
  void sync() {
    Hdf5Series* const all[] = {&position_, &orientation_,    &island_,   &edge_count_,      &edge_,
                               &part_,     &interface_,      &residual_, &largest_impulse_, &t_s_ms_,
                               &t_pr_ms_,  &interface_rows_, &ok_,       &measured_step_,   &step_};
    for (Hdf5Series* series : all) series->sync();
  }

 private:
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

MotionRecorder::MotionRecorder(std::filesystem::path path, const RunOptions& options)
    : path_(std::move(path)), options_(options) {
  for (const Combination& combination : make_combinations(options)) {
    const CombinationName& name = combination.name();
    labels_.push_back(combination_label(name.partitioner, name.refiner, name.solver));
  }
}

MotionRecorder::~MotionRecorder() = default;

void MotionRecorder::record(const OdeWorld& world, const StepProblem& problem, int step,
                            std::span<const StepRecord> rows, std::span<const Outcome> outcomes) {
  if (!file_) {
    if (world.body_count() > kMostBodies) {
      throw std::invalid_argument("--record-motion: " + std::to_string(world.body_count()) +
                                  " bodies are more than the " + std::to_string(kMostBodies) +
                                  " it can number");
    }
    file_ = std::make_unique<File>(path_, world, problem, options_, labels_);
  }
  file_->add_poses(world, step);
  if (!rows.empty()) {
    const BodyGraph graph = body_graph_of(problem);
    file_->add_graph(graph, step);
    for (std::size_t i = 0; i < rows.size(); ++i) file_->add_solution(problem, graph, rows[i], outcomes[i]);
  }
  if (++waiting_steps_ < kSyncSteps) return;
  file_->sync();
  waiting_steps_ = 0;
}

void MotionRecorder::finish() {
  if (!file_) return;
  file_->sync();
  file_.reset();
}

}  // namespace cleave
