// The program cleave_mujoco: steps a model of MuJoCo from where its bodies are, with the velocities (its
// qvel) that standard input gives, and says how long that took and what came out, as one object of JSON.
// scripts/peers_mujoco writes the model from a problem file and reads this.
//
//     cleave_mujoco MODEL.xml REPEATS STEPS < VELOCITIES
//
// REPEATS times the first step from that state (t_..._ms are medians), then STEPS - 1 steps more, each begun
// from the accelerations of the one before (later_step_ms, a median); the first one knows none.
// t_constraint_ms is what MuJoCo's own timer calls constraint: the solve, without collision and without the
// making of rows.
#include <mujoco/mujoco.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <numeric>
#include <string>
#include <vector>

#include "harness/base/median.h"
#include "harness/base/numbers.h"

using cleave::median;

namespace {

struct Deleter {
  void operator()(mjModel* model) const { mj_deleteModel(model); }
  void operator()(mjData* data) const { mj_deleteData(data); }
};

double now_ms() {
  using Clock = std::chrono::steady_clock;
  return std::chrono::duration<double, std::milli>(Clock::now().time_since_epoch()).count();
}

[[noreturn]] void fail(const std::string& text) {
  std::fprintf(stderr, "cleave_mujoco: %s\n", text.c_str());
  std::exit(1);
}

double deepest_m(const mjData& data) {
  double deepest = 0;
  for (int c = 0; c < data.ncon; ++c) deepest = std::max(deepest, -data.contact[c].dist);
  return deepest;
}

// With the inertia of the last step, which is where the last velocities came from.
double kinetic_j(const mjModel& model, const mjData& data) {
  std::vector<double> momentum(model.nv);
  mj_mulM(&model, &data, momentum.data(), data.qvel);
  return std::inner_product(momentum.begin(), momentum.end(), data.qvel, 0.0) / 2;
}

int count(const char* text, const char* name) {
  int value = 0;
  if (!cleave::read_whole(text, value) || value < 1)
    fail(std::string(name) + " is '" + text + "', expected a whole number from 1");
  return value;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 4) fail("usage: cleave_mujoco MODEL.xml REPEATS STEPS");
  const int repeats = count(argv[2], "REPEATS"), steps = count(argv[3], "STEPS");
  mju_user_error = [](const char* text) { fail(text); };
  char error[1000] = "";
  const std::unique_ptr<mjModel, Deleter> model(mj_loadXML(argv[1], nullptr, error, sizeof error));
  if (model == nullptr) fail(error);
  std::vector<double> start(model->nv);
  for (double& velocity : start)
    if (std::scanf("%lf", &velocity) != 1)
      fail("standard input has fewer than " + std::to_string(model->nv) + " velocities");
  const std::unique_ptr<mjData, Deleter> data(mj_makeData(model.get()));
  mjcb_time = now_ms;
  std::vector<double> step_ms, constraint_ms;
  for (int i = 0; i < repeats; ++i) {
    mj_resetData(model.get(), data.get());
    std::ranges::copy(start, data->qvel);
    const double begin = now_ms();
    mj_step(model.get(), data.get());
    step_ms.push_back(now_ms() - begin);
    constraint_ms.push_back(data->timer[mjTIMER_CONSTRAINT].duration);
  }
  std::printf(
      "{\"contacts\": %d, \"rows\": %d, \"iterations\": %d, \"t_step_ms\": %.6g, \"t_constraint_ms\": "
      "%.6g,\n",
      data->ncon, data->nefc, data->solver_iter, median(step_ms), median(constraint_ms));
  std::printf(" \"deepest_m\": %.6g, \"velocity\": [", deepest_m(*data));
  for (int i = 0; i < model->nv; ++i) std::printf("%s%.17g", i > 0 ? ", " : "", data->qvel[i]);
  std::vector<double> later_ms = {step_ms.back()};
  for (int i = 1; i < steps; ++i) {
    const double begin = now_ms();
    mj_step(model.get(), data.get());
    later_ms.push_back(now_ms() - begin);
  }
  std::printf(
      "],\n \"version\": \"%s\", \"later_step_ms\": %.6g, \"later_deepest_m\": %.6g, \"later_kinetic_j\": "
      "%.6g}\n",
      mj_versionString(), median(later_ms), deepest_m(*data), kinetic_j(*model, *data));
  return 0;
}
