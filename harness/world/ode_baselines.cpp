#include "harness/world/ode_baselines.h"

#include <ode/ode.h>

#include <Eigen/QR>
#include <algorithm>
#include <cassert>
#include <limits>
#include <new>
#include <stdexcept>
#include <string>

#include "solver/impulse_set.h"
#include "solver/stage_clock.h"

namespace cleave {
namespace {

constexpr int kThreadsWithoutModel = 2;  // of a clock

constexpr unsigned long kQuickStepSeed = 1;

// The rows [begin, end) of one constraint.
struct RowRange {
  int begin = 0, end = 0;
  int count() const { return end - begin; }
};

// By constraint id: joints first, then contacts. Constraints without rows have an empty range.
std::vector<RowRange> rows_by_constraint(const StepProblem& problem, std::size_t constraints) {
  std::vector<RowRange> ranges(constraints);
  for (int r = 0; r < problem.row_count(); ++r) {
    RowRange& range = ranges.at(problem.row_constraint[r]);
    if (range.count() == 0) range.begin = r;
    assert(range.begin == r || range.end == r);
    range.end = r + 1;
  }
  return ranges;
}

// The world of one step with every joint's feedback switched on.
class FeedbackWorld {
 public:
  FeedbackWorld(const OdeWorld& world, std::span<const ContactPoint> contacts, double erp, double cfm)
      : copy_(world.rebuilt(erp, cfm)),
        contacts_(contacts),
        joints_(copy_->content().joints),
        feedback_(joints_.size() + contacts.size()) {
    for (std::size_t j = 0; j < joints_.size(); ++j) dJointSetFeedback(joints_[j], &feedback_[j]);
  }

  void add_contacts(const StepProblem& problem, std::span<const RowRange> rows, OdeFriction friction) {
    const auto surface = friction == OdeFriction::pyramid ? pyramid : force_limits;
    for (std::size_t k = 0; k < contacts_.size(); ++k) {
      const std::size_t constraint = joints_.size() + k;
      add_contact(contacts_[k], surface(problem, rows[constraint]), &feedback_[constraint]);
    }
  }

  // The impulses whose J^T is h times what ODE says the joint exerts.
  void read_impulses(const StepProblem& problem, std::span<const RowRange> rows,
                     std::span<double> impulse) const {
    for (std::size_t c = 0; c < rows.size(); ++c)
      if (rows[c].count() > 0) read_constraint(problem, rows[c], feedback_[c], impulse);
  }

  void read_velocities(std::span<double> velocity) const {
    for (int i = 0; i < copy_->body_count(); ++i)
      std::ranges::copy(copy_->state(i).velocity, velocity.begin() + 6 * i);
  }

  OdeWorld& world() { return *copy_; }

 private:
  // Largest friction forces along t1 and t2, N; zero where there are no friction rows.
  static dSurfaceParameters force_limits(const StepProblem& problem, const RowRange& rows) {
    std::array<double, 2> limits{};
    for (int r = rows.begin; r < rows.end; ++r)
      if (problem.row_kind[r] == RowKind::friction) {
        assert(problem.lower[r] == -problem.upper[r]);
        limits.at(r - rows.begin - 1) = problem.upper[r] / problem.h_s;
      }
    dSurfaceParameters surface{};
    surface.mode = dContactMu2;
    surface.mu = limits[0];
    surface.mu2 = limits[1];
    return surface;
  }

  static dSurfaceParameters pyramid(const StepProblem& problem, const RowRange& rows) {
    dSurfaceParameters surface{};
    surface.mode = dContactApprox1;
    surface.mu = rows.count() > 1 ? problem.friction_coefficient[rows.begin + 1] : 0;
    return surface;
  }

  void add_contact(const ContactPoint& point, const dSurfaceParameters& surface, dJointFeedback* feedback) {
    dContact contact{};
    contact.surface = surface;
    std::ranges::copy(point.position_m, contact.geom.pos);
    std::ranges::copy(point.normal, contact.geom.normal);
    contact.geom.depth = point.depth_m;
    const auto& bodies = copy_->content().bodies;
    const dJointID joint = dJointCreateContact(copy_->world(), nullptr, &contact);
    dJointAttach(joint, bodies[point.body_a], point.body_b < 0 ? nullptr : bodies[point.body_b]);
    dJointSetFeedback(joint, feedback);
  }

  static void read_constraint(const StepProblem& problem, const RowRange& rows,
                              const dJointFeedback& feedback, std::span<double> impulse) {
    Eigen::Matrix<double, 12, 1> exerted;
    exerted << Eigen::Map<const Eigen::Vector3d>(feedback.f1), Eigen::Map<const Eigen::Vector3d>(feedback.t1),
        Eigen::Map<const Eigen::Vector3d>(feedback.f2), Eigen::Map<const Eigen::Vector3d>(feedback.t2);
    if (problem.row_body[2 * rows.begin + 1] < 0) exerted.tail<6>().setZero();
    using Rows = Eigen::Matrix<double, Eigen::Dynamic, 12, Eigen::RowMajor>;
    const Eigen::Map<const Rows> jacobian(&problem.jacobian[12 * rows.begin], rows.count(), 12);
    const Eigen::VectorXd force = jacobian.transpose().colPivHouseholderQr().solve(exerted);
    for (int k = 0; k < rows.count(); ++k) impulse[rows.begin + k] = problem.h_s * force[k];
  }

  std::unique_ptr<OdeWorld> copy_;
  std::span<const ContactPoint> contacts_;
  const std::vector<dJointID>& joints_;
  std::vector<dJointFeedback> feedback_;  // joints, then contacts
};

// The parameters of both; what one of them does not have is not read.
struct Options {
  bool quick;  // dWorldQuickStep
  OdeFriction friction;
  int quickstep_iterations = 0;
  int step_max_rows = 0;
};

class OdeSolver : public StepSolver {
 public:
  OdeSolver(const Options& options, const StepContext& context) : options_(options), context_(context) {}
  bool uses_partition() const override { return false; }

 private:
  std::string refuse_set(const StepProblem& problem) override {
    return find_set_refusal("solver", options_.quick ? "ode-quickstep" : "ode-step", problem);
  }

  SolveSummary do_solve(const StepProblem& problem, const Parts&, Solution& solution) override {
    SolveSummary summary;
    summary.strategy = options_.quick ? "ode-quickstep" : "ode-step";
    summary.kernel = "-";
    summary.iterations = summary.factorizations = -1;  // ODE does not say
    summary.factor_mflop_local = summary.factor_mflop_interface = summary.factor_mflop_done =
        std::numeric_limits<double>::quiet_NaN();
    if (context_.world == nullptr) {
      summary.status = SolveStatus::refused;
      summary.message = "no world to rebuild: a problem alone does not hold one";
    } else if (!options_.quick && problem.row_count() > options_.step_max_rows) {
      summary.status = SolveStatus::refused;
      summary.message = std::to_string(problem.row_count()) + " rows, more than --ode-step-max-rows " +
                        std::to_string(options_.step_max_rows);
    } else {
      step(problem, solution, summary);
    }
    return summary;
  }

  void step(const StepProblem& problem, Solution& solution, SolveSummary& summary) {
    FeedbackWorld feedback(*context_.world, context_.contacts, context_.erp, context_.cfm);
    const std::vector<RowRange> rows =
        rows_by_constraint(problem, context_.world->content().joints.size() + context_.contacts.size());
    feedback.add_contacts(problem, rows, options_.friction);
    if (options_.quick) {
      dWorldSetQuickStepNumIterations(feedback.world().world(), options_.quickstep_iterations);
      dRandSetSeed(kQuickStepSeed);
      summary.iterations = options_.quickstep_iterations;
    }
    std::string text;
    clock_.start();
    try {
      // Zero: it found no memory, and moved nothing.
      if ((options_.quick ? dWorldQuickStep : dWorldStep)(feedback.world().world(), problem.h_s) == 0)
        throw std::bad_alloc();
    } catch (const std::runtime_error& error) {
      summary.status = SolveStatus::crashed;
      text = error.what();
    }
    summary.times = clock_.stop();
    summary.interface_unknowns = summary.fallbacks = summary.refinements = -1;
    std::string first_message;
    summary.engine_messages = feedback.world().take_message_count(&first_message);
    summary.message = text.empty() ? first_message : text;
    if (summary.status == SolveStatus::crashed) return;
    feedback.read_impulses(problem, rows, solution.impulse);
    feedback.read_velocities(solution.velocity);
  }

  Options options_;
  const StepContext& context_;
  StageClock clock_{kThreadsWithoutModel};  // what is inside ODE's call is not known
};

const Parameter& quickstep_iterations() {
  static const Parameter parameter{.name = "quickstep-iterations",
                                   .kind = Parameter::Kind::integer,
                                   .default_value = "20",
                                   .range = {1, std::numeric_limits<double>::infinity()},
                                   .help = "iterations of ode-quickstep",
                                   .source = "ODE manual, dWorldSetQuickStepNumIterations"};
  return parameter;
}

const Parameter& step_max_rows() {
  static const Parameter parameter{.name = "ode-step-max-rows",
                                   .kind = Parameter::Kind::integer,
                                   .default_value = "500",
                                   .range = {0, std::numeric_limits<double>::infinity()},
                                   .help = "ode-step refuses a step of more rows: its time explodes"};
  return parameter;
}

const Parameter& friction() {
  static const Parameter parameter{
      .name = "ode-friction",
      .kind = Parameter::Kind::word,
      .default_value = "limits",
      .words = {"limits", "pyramid"},
      .help = "limits: the problem's bounds as force limits; pyramid: bounds that ODE's own solver finds",
      .source = "ODE manual, dContactApprox1"};
  return parameter;
}

}  // namespace

std::span<const AlgorithmEntry> ode_baselines() {
  static const AlgorithmEntry table[] = {
      {"ode-step",
       "ODE's dWorldStep on the same problem, as far as its rows are not too many",
       "Baraff 1994; ODE manual",
       {step_max_rows(), friction()}},
      {"ode-quickstep",
       "ODE's dWorldQuickStep on the same problem, a fixed number of iterations",
       "ODE manual",
       {quickstep_iterations(), friction()}},
  };
  return table;
}

OdeFriction ode_friction(const Settings& settings) { return settings.word<OdeFriction>(friction()); }

std::unique_ptr<StepSolver> make_ode_baseline(const Algorithm& algorithm, const StepContext& context) {
  const Settings& settings = algorithm.settings;
  if (algorithm.name == "ode-step")
    return std::make_unique<OdeSolver>(Options{.quick = false,
                                               .friction = ode_friction(settings),
                                               .step_max_rows = settings.integer("ode-step-max-rows")},
                                       context);
  if (algorithm.name == "ode-quickstep")
    return std::make_unique<OdeSolver>(
        Options{.quick = true,
                .friction = ode_friction(settings),
                .quickstep_iterations = settings.integer("quickstep-iterations")},
        context);
  return nullptr;
}

}  // namespace cleave
