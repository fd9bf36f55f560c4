#include "harness/commands/manifested_work.h"

#include <signal.h>

#include <cstdio>

#include "harness/commands/command.h"

namespace cleave {
namespace {

std::atomic<bool> stop{false};
static_assert(std::atomic<bool>::is_always_lock_free);

void stop_on_signals() {
  struct sigaction action {};
  action.sa_handler = [](int) { stop = true; };
  action.sa_flags = static_cast<int>(SA_RESETHAND);
  for (const int signal : {SIGINT, SIGTERM}) ::sigaction(signal, &action, nullptr);
}

int exit_code(const RunSummary& summary) {
  if (summary.interrupted) return kExitInterrupted;
  return summary.all_ok() ? kExitOk : kExitCellsFailed;
}

}  // namespace

const std::atomic<bool>& stop_requested() { return stop; }

int do_manifested_work(Manifest& manifest, const std::function<RunSummary()>& work) {
  stop_on_signals();
  const RunSummary summary = manifest.around(work);
  std::fprintf(stderr, "%s%s", summary.text().c_str(), summary.interrupted ? "interrupted\n" : "");
  return exit_code(summary);
}

}  // namespace cleave
