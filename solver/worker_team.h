// Threads that run the tasks of one parallel stage after another: independent ones, or those of a graph.
//
// A stage is over when its tasks are, not when every thread has come by: a thread that the machine holds
// back, because its core is busy with something else, costs nothing unless it holds a task. (The barrier at
// the end of an OpenMP loop waits for every thread, spinning. One busy loop of another login made a solve on
// two threads 17 times slower that way.) Threads without work look for it for a moment and then sleep; for
// how long can be set by CLEAVE_LOOK_OUT_US in the environment, where a machine is known to be one's own.
// OpenMP makes the threads, so its settings apply to them: OMP_PLACES, OMP_PROC_BIND, OMP_STACKSIZE.
//
// Beside the stages go background tasks: a thread that has nothing else to do takes one, which holds up no
// stage.
//
// Every thread has two queues, of tasks that have waited for others, which come first, and of tasks that wait
// for none. A task is put into a queue of its home, and a thread whose own are empty takes from the others':
// the same tasks of stage after stage mostly meet the same core and what it has in its cache.
#pragma once

#include <atomic>
#include <cstdint>
#include <exception>
#include <memory>
#include <mutex>
#include <thread>
#include <vector>

#include "solver/background_task.h"
#include "solver/task_graph.h"

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

  // Calls task(context, i) for i = 0..count-1, in any order, and returns when all have returned. The first
  // exception of a task is thrown here, once no task is running; tasks not started by then are left out. No
  // task may wait for another. Not to be called from within a task.
  void run(int count, Task task, void* context);

  // The tasks of a graph, each started when those it waits for have returned.
  void run(const TaskGraph& graph, Task task, void* context);

  // Offers a task to the other threads, unless they have not begun another caller's.
  void begin(BackgroundTask& task);
  // Returns once it is done; does it here where nobody has begun it. Throws what it threw. Its work is empty
  // afterwards; nothing where it was so before.
  void finish(BackgroundTask& task);
  // The same, but what nobody has begun is left out, and what it threw too.
  void cancel(BackgroundTask& task);

  // For tests: tasks of graphs are listed in an order drawn from this seed, as far as the graph allows; 0, in
  // the order in which they become ready. Not while a stage runs.
  void shuffle(std::uint64_t seed) { shuffle_seed_ = seed; }
  bool shuffles() const { return shuffle_seed_ != 0; }

  int threads() const { return threads_; }

 private:
  // Who counts `open` down by one owns a ticket, the next number of `taken`, and with it a task.
  struct alignas(64) Queue {
    std::atomic<int> open{0};  // tasks that nobody has started
    std::atomic<int> taken{0};
    std::atomic<int> listed{0};  // of a graph: entries of `tasks` in use or about to be
    int first = 0;               // of independent tasks: the first; those of the other tickets follow
    int capacity = 0;
    std::unique_ptr<std::atomic<int>[]> tasks;  // of a graph: by ticket, -1 until it is there
  };

  void begin_stage(int count, Task task, void* context);
  void finish_stage();
  void list_first_tasks();
  Queue& enter(int task, bool has_waited);
  void release_next(int task);
  int index_of(Queue& queue);
  void take_all(int thread);
  bool take_one(int thread);
  bool take_from(Queue& queue);
  bool has_open() const;
  template <class HasWork, class Ends>
  void watch(const HasWork& has_work, const Ends& ends);
  bool take_background();
  bool leave_out(BackgroundTask& task);
  void call_others();
  void work(int thread);
  void dismiss();

  const int threads_;
  std::mutex one_caller_;
  // The stage at hand. Written by its caller while nobody holds a task. What threads write while tasks run
  // has cache lines of its own: a line that another core wrote last takes as long to come as a small task.
  alignas(64) Task task_ = nullptr;
  void* context_ = nullptr;
  const TaskGraph* graph_ = nullptr;
  std::exception_ptr failure_;
  std::atomic<bool> failed_{false};
  std::unique_ptr<Queue[]> queues_;  // by thread: of tasks that wait for none, then of those that have waited
  int waits_capacity_ = 0;
  std::unique_ptr<std::atomic<int>[]> waits_;  // of a graph: how many tasks each still waits for
  std::vector<int> first_tasks_, home_count_;
  std::uint64_t shuffle_seed_ = 0;
  std::atomic<bool> stop_{false};
  alignas(64) BackgroundPlace background_;
  alignas(64) std::atomic<int> unfinished_{0};
  // Threads that found nothing to do watch for a change of `calls_`.
  alignas(64) std::atomic<std::uint32_t> calls_{0};
  alignas(64) std::atomic<int> watching_{0};
  alignas(64) std::atomic<int> granted_{0};  // threads of the region, once it has begun
  std::thread workers_;
};

}  // namespace cleave
