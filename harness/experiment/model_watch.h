// cleave run --explain-model: what a run modelled that never mattered to it, and what it would have been
// without it.
//
// The measured steps are watched, by pairs of bodies, as a contact point of one step has no name in the next:
//
//     contact_apart           pairs none of whose rows ever carried more than kUnloaded (a frozen box may
//                             hold by friction alone)
//     friction_unloaded       other pairs, none of whose friction rows ever did
//     friction_never_at_bound pairs with loaded friction, no row of which came to its bound: a bilateral row
//                             would do
//     contact_cap             pairs that had as many contact points as --contact-cap allows; what half as
//                             many do is tried
//     body_at_rest            bodies never kMoved from where they were first, and never faster than kFast
//     box_beyond_cone         contacts of frozen boxes whose friction is beyond mu times the normal impulse;
//                             the cone is tried
//
// Of the watched steps some are kept, at least four where there are as many, evenly spaced. These are solved
// again as they were and as they would be without what was found, by `exact` on one thread, each from its
// warm start.
#pragma once

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "harness/experiment/options.h"
#include "harness/experiment/simulation.h"

namespace cleave {

inline constexpr const char* kFindingsFile = "explain_model.csv";
inline constexpr double kUnloaded = 1e-9;  // of the largest impulse of the step
inline constexpr double kMoved = 1e-3;     // m
inline constexpr double kFast = 1e-2;      // m/s and rad/s

struct ModelFinding {
  std::string name;                 // of the list above
  long found = 0, of = 0;           // pairs, bodies or contacts
  int steps = 0, samples = 0;       // watched, and solved again
  double rows_share = 0;            // rows that would go, of all rows of the samples
  double t_s_ms = 0, saved_ms = 0;  // mean over the samples: as it was, and what would be saved
  double change_m_per_s = 0;        // largest change of a velocity in the samples
  std::string advice;               // what to do about it; one line
};

class ModelWatch {
 public:
  explicit ModelWatch(const RunOptions& options) : options_(options) {}

  // Ignores steps that are not measured, have no row, or were solved by nobody.
  void watch(const ObservedStep& step);

  // One of every name, in the order of the list.
  std::vector<ModelFinding> findings() const;

 private:
  using Pair = std::pair<int, int>;  // the lower body first; static: -1
  struct PairRecord {
    bool touches = false, reached_cap = false;
    bool has_friction = false, has_loaded_friction = false, was_at_bound = false;  // of its friction rows
  };
  struct Sample {
    StepProblem problem;
    std::vector<char> behind_half_cap;  // (m) of contacts that half the contact cap would leave out
    int number;                         // of the watched steps
  };

  static Pair pair_of(const StepProblem& problem, int row);
  void watch_pairs(const ObservedStep& step, const Solution& solution);
  void watch_bodies(const ObservedStep& step, const Solution& solution);
  void watch_cone(const StepProblem& problem, const Solution& solution);
  void keep_sample(const ObservedStep& step);
  template <class Change>
  ModelFinding try_out(ModelFinding finding, Change change) const;
  template <class IsFound, class Change>
  ModelFinding find_pairs(const char* name, const char* advice, RowKind kind, IsFound is_found,
                          Change change) const;
  ModelFinding find_full_pairs() const;
  ModelFinding find_still_bodies() const;
  ModelFinding find_boxes_beyond_cones() const;

  RunOptions options_;
  int steps_ = 0, stride_ = 1;
  std::map<Pair, PairRecord> pairs_;
  std::vector<double> first_position_m_;  // (n, 3)
  std::vector<char> has_moved_;           // (n)
  long contacts_ = 0, contacts_beyond_cone_ = 0;
  std::vector<Sample> samples_;
};

// finding,found,of,... and a line each.
std::string findings_csv(const std::vector<ModelFinding>& findings);

// For people: a line each, with what was not found told in the last.
std::string findings_text(const std::vector<ModelFinding>& findings);

}  // namespace cleave
