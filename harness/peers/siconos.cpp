// Solvers `siconos-nsgs` and `siconos-newton`: Coulomb's law by the nonsmooth Gauss-Seidel method and the
// semi-smooth Newton method (Alart and Curnier) of Siconos 4.4, both on the local form
//
//     u = W r + q,   W = J M^-1 J^T + C,   q = J v0 - b,
//     r_n >= 0,  u_n >= 0,  r_n u_n = 0,   |r_t| <= mu r_n  and, sliding,  r_t = -mu r_n u_t / |u_t|
//     (Acary, Bremond and Huber, "On solving contact problems with Coulomb friction", 2018)
//
// of the contacts, joints having been eliminated (contact_form.h).
//
// They are run to an error (siconos.h) of `peer-tolerance`. W goes over in blocks of 3x3 to the first, as
// triplets to the second.
#include "harness/peers/siconos.h"

#include <numerics/FrictionContactProblem.h>
#include <numerics/Friction_cst.h>
#include <numerics/NonSmoothDrivers.h>
#include <numerics/NumericsMatrix.h>
#include <numerics/NumericsSparseMatrix.h>
#include <numerics/SolverOptions.h>
#include <numerics/SparseBlockMatrix.h>
#include <numerics/fc3d_compute_error.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <stdexcept>
#include <vector>

#include "harness/base/stopwatch.h"
#include "harness/peers/contact_form.h"
#include "harness/peers/peer.h"

namespace cleave {
namespace {

struct DeleteOptions {
  void operator()(SolverOptions* options) const { solver_options_delete(options); }
};

enum class Storage { triplets, blocks };

// A problem of Siconos, in memory of its own kind: its functions free what they were given with free().
class LocalForm {
 public:
  // Throws as ContactForm does.
  LocalForm(const StepProblem& step, Storage storage) : form_(step) {
    const int contacts = form_.contact_count(), m = kRowsOfContact * contacts;
    matrix_ = NM_create(NM_SPARSE, m, m);
    NM_triplet_alloc(matrix_, m);
    matrix_->matrix2->origin = NSM_TRIPLET;
    for (int r = 0; r < m; ++r)
      for (int c = 0; c < m; ++c)
        if (const double value = form_.matrix[static_cast<std::size_t>(m) * r + c]; value != 0)
          NM_entry(matrix_, r, c, value);
    if (storage == Storage::blocks) {
      NumericsMatrix* triplets = matrix_;
      SparseBlockStructuredMatrix* blocks = SBM_new();
      SBM_from_csparse(kRowsOfContact, NM_csc(triplets), blocks);
      matrix_ = NM_new_SBM(m, m, blocks);
      NM_free(triplets);
    }
    problem_ = {kRowsOfContact, contacts, matrix_, form_.free_slack.data(),
                form_.friction_coefficient.data()};
  }
  ~LocalForm() { NM_free(matrix_); }
  LocalForm(const LocalForm&) = delete;
  LocalForm& operator=(const LocalForm&) = delete;

  FrictionContactProblem* get() { return &problem_; }
  const ContactForm& contacts() const { return form_; }
  double norm_of_q() const {
    double sum = 0;
    for (const double value : form_.free_slack) sum += value * value;
    return std::sqrt(sum);
  }

 private:
  ContactForm form_;
  NumericsMatrix* matrix_;
  FrictionContactProblem problem_;
};

std::unique_ptr<SolverOptions, DeleteOptions> make_options(int solver) {
  return std::unique_ptr<SolverOptions, DeleteOptions>(solver_options_create(solver));
}

// Siconos divides by the largest of |r|, |u| and a norm that it is given, and impulses of heavy bodies are
// far above |q|. With a power of two above all of them, what it divides by is known and taken back without
// rounding.
double error_over_q(LocalForm& form, std::vector<double> reaction) {
  const auto options = make_options(SICONOS_FRICTION_3D_NSGS);
  const double above_all = std::ldexp(1.0, 300), norm = form.norm_of_q();
  std::vector<double> velocity(reaction.size(), 0.0);
  double error = 0;
  fc3d_compute_error(form.get(), reaction.data(), velocity.data(), 1.0, options.get(), above_all, &error);
  return error * above_all / (norm > 0 ? norm : 1.0);
}

// Its solvers stop in that other measure: they go on from where they stopped, with a smaller tolerance, until
// the error is what was asked for or they give up.
void run_to_tolerance(int solver, LocalForm& form, const Settings& settings, std::vector<double>& reaction,
                      PeerAnswer& answer) {
  const double wanted = settings.number(parameters::peer_tolerance().name);
  const int most = settings.integer(parameters::peer_iterations().name);
  std::vector<double> velocity(reaction.size(), 0.0);
  answer.iterations = 0;
  answer.solve_ms = 0;
  int info = 0;
  double error = 0;
  for (double tolerance = wanted; info == 0 && answer.iterations < most; tolerance *= wanted / (2 * error)) {
    const auto options = make_options(solver);
    options->dparam[SICONOS_DPARAM_TOL] = tolerance;
    options->iparam[SICONOS_IPARAM_MAX_ITER] = most - answer.iterations;
    Stopwatch watch;
    info = fc3d_driver(form.get(), reaction.data(), velocity.data(), options.get());
    answer.solve_ms += watch.lap_ms();
    answer.iterations += std::max(1, options->iparam[SICONOS_IPARAM_ITER_DONE]);
    error = error_over_q(form, reaction);
    answer.claims_success = error <= wanted;
    if (answer.claims_success) return;
  }
  answer.message = "Siconos's fc3d_driver returned " + std::to_string(info);
}

PeerAnswer solve(int solver, Storage storage, const StepProblem& step, std::span<const double> start,
                 const Settings& settings) {
  PeerAnswer answer;
  std::optional<LocalForm> form;
  try {
    form.emplace(step, storage);
  } catch (const std::invalid_argument& refusal) {
    answer.message = refusal.what();
    return answer;
  }
  std::vector<double> reaction = form->contacts().contact_impulse(start);
  run_to_tolerance(solver, *form, settings, reaction, answer);
  answer.impulse = form->contacts().whole_impulse(reaction);
  return answer;
}

}  // namespace

double siconos_error(const StepProblem& problem, std::span<const double> impulse) {
  LocalForm form(problem, Storage::triplets);
  return error_over_q(form, form.contacts().contact_impulse(impulse));
}

PeerAnswer solve_siconos_nsgs(const StepProblem& problem, std::span<const double> start,
                              const Settings& settings) {
  return solve(SICONOS_FRICTION_3D_NSGS, Storage::blocks, problem, start, settings);
}

PeerAnswer solve_siconos_newton(const StepProblem& problem, std::span<const double> start,
                                const Settings& settings) {
  return solve(SICONOS_FRICTION_3D_NSN_AC, Storage::triplets, problem, start, settings);
}

}  // namespace cleave
