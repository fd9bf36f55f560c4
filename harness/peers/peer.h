// What one peer, a solver of somebody else's library, is to this project: a function from a step problem to
// impulses.
//
// It runs in a child process of its own (peer_solver.h), so it may crash, print, keep global state and take
// for ever. One file a library, one row a solver in peer_table.cpp.
#pragma once

#include <limits>
#include <span>
#include <string>
#include <vector>

#include "harness/base/parameter.h"
#include "solver/step_problem.h"

namespace cleave {

struct PeerAnswer {
  bool claims_success = false;  // the library's own word; the judge has his
  std::string message;          // what it said, where it does not claim success
  int iterations = -1;          // -1: it does not say
  double solve_ms = std::numeric_limits<double>::quiet_NaN();  // of the library's call alone
  std::vector<double> impulse;                                 // (m) N s
};

// start: (m) impulses that a library may begin from; most of them begin from zero whatever they are given.
// settings: values of the row's parameters.
using PeerFunction = PeerAnswer (*)(const StepProblem& problem, std::span<const double> start,
                                    const Settings& settings);

// Declared by every peer that has them (peer_parameters.cpp).
namespace parameters {

const Parameter& peer_max_rows();
const Parameter& peer_timeout();
const Parameter& peer_tolerance();
const Parameter& peer_iterations();

}  // namespace parameters

PeerAnswer solve_bullet_dantzig(const StepProblem&, std::span<const double> start, const Settings&);
PeerAnswer solve_bullet_lemke(const StepProblem&, std::span<const double> start, const Settings&);
PeerAnswer solve_bullet_pgs(const StepProblem&, std::span<const double> start, const Settings&);
PeerAnswer solve_dart_dantzig(const StepProblem&, std::span<const double> start, const Settings&);
PeerAnswer solve_dart_pgs(const StepProblem&, std::span<const double> start, const Settings&);
PeerAnswer solve_ipopt(const StepProblem&, std::span<const double> start, const Settings&);
PeerAnswer solve_siconos_nsgs(const StepProblem&, std::span<const double> start, const Settings&);
PeerAnswer solve_siconos_newton(const StepProblem&, std::span<const double> start, const Settings&);

}  // namespace cleave
