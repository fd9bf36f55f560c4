// Threads that run the independent tasks of one parallel stage after another.
//
// A stage is over when its tasks are, not when every thread has come by: a thread that the machine holds
// back, because its core is busy with something else, costs nothing unless it holds a task. (The barrier at
// the end of an OpenMP loop waits for every thread, spinning. One busy loop of another login made a solve on
// two threads 17 times slower that way.) Threads without work look for it for a moment and then sleep; for
// how long can be set by CLEAVE_LOOK_OUT_US in the environment, where a machine is known to be one's own.
// OpenMP makes the threads, so its settings apply to them: OMP_PLACES, OMP_PROC_BIND, OMP_STACKSIZE.
#pragma once

#include <atomic>
#include <cstdint>
#include <exception>
#include <mutex>
#include <thread>

namespace cleave {

class WorkerTeam {
 public:
  // >= 1; the caller of run() is one of them. Throws std::runtime_error where the system or OpenMP
  // grants fewer.
  explicit WorkerTeam(int threads);
  ~WorkerTeam();
  WorkerTeam(const WorkerTeam&) = delete;
  WorkerTeam& operator=(const WorkerTeam&) = delete;

  // The team of this many threads that all solvers of the process share.
  static WorkerTeam& shared(int threads);

  using Task = void (*)(void* context, int index);

  // Calls task(context, i) for i = 0..count-1 and returns when all have returned. They are started in
  // ascending order, so a task may wait for an earlier one where no task of the stage throws. The first
  // exception of a task is thrown here, once no task is running; tasks not started by then are left out. Not
  // to be called from within a task.
  void run(int count, Task task, void* context);

  int threads() const { return threads_; }

 private:
  void dismiss();
  bool take_one();
  void work();
  void finish_one();

  const int threads_;
  std::mutex one_caller_;
  // The stage at hand. Written by its caller while nobody holds a task.
  Task task_ = nullptr;
  void* context_ = nullptr;
  int count_ = 0;
  std::exception_ptr failure_;
  std::atomic<bool> failed_{false};
  // Number of the stage in the upper half, tasks not yet started in the lower: who counts it down by one owns
  // a task, and a thread that comes late finds none.
  std::atomic<std::uint64_t> open_{0};
  std::atomic<int> unfinished_{0};
  std::atomic<bool> stop_{false};
  std::atomic<int> granted_{0};  // threads of the region, once it has begun
  std::thread workers_;
};

// Waits until a counter that other threads raise has reached a value: for a moment awake, then asleep.
void wait_until(std::atomic<int>& counter, int at_least);
// Raises it and wakes who waits for it.
void raise(std::atomic<int>& counter);

}  // namespace cleave
