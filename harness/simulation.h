// The step loop: ODE finds contacts, the harness turns them into a step problem, every combination solves it,
// one solution advances the world.
#pragma once

#include <atomic>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "harness/combination.h"
#include "harness/csv_recorder.h"
#include "harness/ode_world.h"
#include "harness/options.h"
#include "harness/run_summary.h"

namespace cleave {

class Simulation {
 public:
  using Progress = std::function<void(int steps_done, int steps_total)>;
  // Sees the problem of every measured step before anyone solves it; may fill columns of its rows.
  using Observer = std::function<void(const OdeWorld& world, const StepProblem& problem, StepRecord& common)>;
  // Sees every step before the world is advanced, with the rows and outcomes of all combinations where it was
  // measured.
  using Watcher = std::function<void(const OdeWorld& world, const StepProblem& problem, int step,
                                     std::span<const StepRecord> rows, std::span<const Outcome> outcomes)>;

  // Makes every solver, partitioner and refiner, without touching ODE or the disk. stop: once true, the run
  // ends after the step at hand.
  Simulation(const RunOptions& options, const std::atomic<bool>& stop, Observer observe = {},
             Watcher watch = {});

  // Runs all steps (--mode separate: of one world after the other) and writes each measured step's rows when
  // the step is over. Throws std::runtime_error when a scene holds something that cannot be extracted, or
  // when rows cannot be written.
  RunSummary run(CsvRecorder& recorder, const Progress& progress);

  // What has been counted so far, also after an exception.
  const RunSummary& summary() const { return summary_; }

 private:
  // The rows of one measured step and the solutions they stand for.
  struct Measured {
    std::vector<StepRecord> rows;
    std::vector<Outcome> outcomes;
  };

  void run_world(std::span<Combination> combinations, Combination& advancing, CsvRecorder& recorder,
                 const Progress& progress);
  static void show(const OdeWorld& world, std::span<const ContactPoint> contacts,
                   std::span<Combination> combinations, Combination& advancing);
  void predict_bounds(StepProblem& problem, Combination& advancing);
  Measured measure(std::span<Combination> combinations, const StepProblem& problem, const StepRecord& common);
  void finish_rows(Measured& measured, const OdeWorld& world, const Outcome& advance);
  void record(std::span<const StepRecord> rows, CsvRecorder& recorder);
  void record_skipped(std::span<const Combination> combinations, int first_step, const std::string& reason,
                      CsvRecorder& recorder);

  StepRecord blank_row(int step) const;
  int total_steps() const;
  bool is_measured(int step) const;

  RunOptions options_;
  const std::atomic<bool>& stop_;
  Observer observe_;
  Watcher watch_;
  StepRecord run_row_;  // the columns all rows share
  std::vector<Combination> combinations_;
  RunSummary summary_;
};

}  // namespace cleave
