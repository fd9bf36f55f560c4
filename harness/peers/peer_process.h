// Runs a peer in a child process and brings its answer back, or says how the child ended.
#pragma once

#include <atomic>
#include <functional>

#include "harness/peers/peer.h"
#include "solver/step_solver.h"

namespace cleave {

struct PeerEnd {
  SolveStatus status = SolveStatus::ok;  // ok: there is an answer; else timeout, crashed or out_of_memory
  std::string message;                   // why there is none
  PeerAnswer answer;
};

// timeout_s: wall time until the child is killed. Where stop comes true it is killed too, and Stopped thrown.
// What the child prints is lost. A std::exception of `work` is crashed with its text, std::bad_alloc
// out_of_memory. Throws std::bad_alloc where no child can be made.
PeerEnd run_peer(const std::function<PeerAnswer()>& work, double timeout_s, const std::atomic<bool>* stop);

}  // namespace cleave
