#include "harness/commands/motion_recorder.h"

#include <stdexcept>
#include <utility>

#include "harness/experiment/body_marks.h"
#include "harness/experiment/option_values.h"
#include "harness/experiment/problem_graph.h"
#include "harness/world/extract_shapes.h"

namespace cleave {
namespace {

std::vector<MotionPose> poses_of(const OdeWorld& world) {
  std::vector<MotionPose> poses;
  for (int i = 0; i < world.body_count(); ++i) {
    const BodyState state = world.state(i);
    poses.push_back({state.position_m, state.orientation});
  }
  return poses;
}

MotionGraph motion_graph(const BodyGraph& graph) {
  MotionGraph motion;
  std::vector<int> islands;
  count_islands(graph, &islands);
  motion.island.assign(islands.begin(), islands.end());
  for (int i = 0; i < graph.body_count(); ++i)
    for (const int other : graph.neighbours(i))
      if (i < other)
        motion.edge.push_back({static_cast<std::uint16_t>(i), static_cast<std::uint16_t>(other)});
  return motion;
}

MotionSolution motion_solution(const StepProblem& problem, const BodyGraph& graph, const StepRecord& row,
                               const Outcome& outcome) {
  BodyMarks marks = mark_bodies(problem, graph, outcome.parts.part_of_body, outcome.solution.impulse);
  return {std::move(marks.part),
          std::move(marks.interface),
          std::move(marks.residual_m_per_s),
          std::move(marks.largest_impulse_n_s),
          static_cast<float>(row.t_s_ms),
          static_cast<float>(row.t_pr_ms),
          row.interface_rows,
          row.status == to_string(SolveStatus::ok)};
}

}  // namespace

MotionRecorder::MotionRecorder(std::filesystem::path path, const RunOptions& options)
    : path_(std::move(path)), options_(options) {
  for (const CombinationName& name : combination_names(options)) labels_.push_back(name.label());
}

MotionRecorder::~MotionRecorder() = default;

MotionSetup MotionRecorder::setup(const ObservedStep& step) const {
  MotionSetup setup;
  setup.run_id = run_id(options_);
  setup.scene = options_.scene.text;
  setup.seed = options_.seed;
  setup.h_s = step.problem.h_s;
  setup.steps = options_.steps;
  setup.measure_every = options_.measure_every;
  setup.labels = labels_;
  for (int i = 0; i < step.problem.body_count(); ++i) setup.mass_kg.push_back(step.problem.mass[36 * i]);
  setup.shapes = extract_shapes(*step.context.world);
  return setup;
}

void MotionRecorder::record(const ObservedStep& step) {
  const OdeWorld& world = *step.context.world;
  if (!file_) {
    if (world.body_count() > kMostMotionBodies) {
      throw std::invalid_argument("--record-motion: " + std::to_string(world.body_count()) +
                                  " bodies are more than the " + std::to_string(kMostMotionBodies) +
                                  " it can number");
    }
    file_ = std::make_unique<MotionFile>(path_, setup(step));
  }
  file_->add_poses(step.step, poses_of(world));
  if (!step.rows.empty()) {
    const BodyGraph graph = body_graph_of(step.problem);
    file_->add_graph(step.step, motion_graph(graph));
    for (std::size_t i = 0; i < step.rows.size(); ++i)
      file_->add_solution(motion_solution(step.problem, graph, step.rows[i], step.outcomes[i]));
  }
  file_->end_step();
}

void MotionRecorder::finish() {
  if (!file_) return;
  file_->publish();
  file_.reset();
}

}  // namespace cleave
