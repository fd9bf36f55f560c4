#include "solver/worker_team.h"

#include <immintrin.h>
#include <omp.h>

#include <algorithm>
#include <cassert>
#include <map>
#include <memory>
#include <random>
#include <stdexcept>
#include <string>
#include <utility>

#include "solver/look_out.h"
#include "solver/thread_making.h"

namespace cleave {
namespace {

// A stage that a task began would wait for that task.
thread_local bool is_in_task = false;

}  // namespace

WorkerTeam::WorkerTeam(int threads)
    : threads_(threads), queues_(std::make_unique<Queue[]>(2 * threads)), home_count_(threads) {
  if (threads == 1) return;
  asked_look_out();  // its error belongs to the caller
  load_unwinder();
  check_threads(threads);
  const SignalsHeldBack by_the_workers;
  // The first member of the region has the place of the caller and only waits for the others.
  workers_ = std::thread([this] {
#pragma omp parallel num_threads(threads_)
    {
      if (omp_get_thread_num() == 0) {
        granted_ = omp_get_num_threads();
        granted_.notify_all();
      } else {
        work(omp_get_thread_num());
      }
    }
  });
  granted_.wait(0);
  if (granted_ == threads_) return;
  dismiss();
  throw std::runtime_error("OpenMP grants " + std::to_string(granted_) + " of " + std::to_string(threads_) +
                           " threads; OMP_THREAD_LIMIT and OMP_DYNAMIC bound them");
}

WorkerTeam::~WorkerTeam() {
  if (threads_ > 1) dismiss();
}

void WorkerTeam::dismiss() {
  stop_ = true;
  calls_.fetch_add(1);
  calls_.notify_all();
  // OpenMP ends the program from that thread where the system makes no more.
  if (workers_.get_id() == std::this_thread::get_id()) return workers_.detach();
  workers_.join();
}

WorkerTeam& WorkerTeam::shared(int threads) {
  static std::mutex mutex;
  static std::map<int, std::unique_ptr<WorkerTeam>> teams;
  const std::scoped_lock lock(mutex);
  std::unique_ptr<WorkerTeam>& team = teams[threads];
  if (team == nullptr) team = std::make_unique<WorkerTeam>(threads);
  return *team;
}

// Wakes who sleeps and ends every look-out. A thread announces itself as watching before it looks into the
// queues for the last time, so that either it sees the new task or is seen here.
void WorkerTeam::call_others() {
  if (watching_.load() == 0) return;
  calls_.fetch_add(1);
  calls_.notify_all();
}

// The task of the next ticket. Its entry may be a moment behind the count of open tasks.
int WorkerTeam::index_of(Queue& queue) {
  const int ticket = queue.taken.fetch_add(1, std::memory_order_relaxed);
  if (graph_ == nullptr) return queue.first + ticket;
  int index;
  while ((index = queue.tasks[ticket].load(std::memory_order_acquire)) < 0) _mm_pause();
  return index;
}

// Runs the next task of a queue that nobody has started; false when there is none.
bool WorkerTeam::take_from(Queue& queue) {
  int open = queue.open.load(std::memory_order_acquire);
  do {
    if (open <= 0) return false;
  } while (!queue.open.compare_exchange_weak(open, open - 1, std::memory_order_acq_rel));
  const int index = index_of(queue);
  if (!failed_.load(std::memory_order_acquire)) {
    is_in_task = true;
    try {
      task_(context_, index);
    } catch (...) {
      if (!failed_.exchange(true)) failure_ = std::current_exception();
    }
    is_in_task = false;
  }
  if (graph_ != nullptr) release_next(index);
  return true;
}

bool WorkerTeam::has_open() const {
  return std::any_of(queues_.get(), queues_.get() + 2 * threads_,
                     [](const Queue& queue) { return queue.open.load() > 0; });
}

bool WorkerTeam::take_one(int thread) {
  for (int k = 0; k < threads_; ++k) {
    const int home = (thread + k) % threads_;
    if (take_from(queues_[threads_ + home]) || take_from(queues_[home])) return true;
  }
  return false;
}

// As long as there are some. That they have returned is said once for all of them: the count is everyone's.
void WorkerTeam::take_all(int thread) {
  int count = 0;
  while (take_one(thread)) ++count;
  if (count > 0 && unfinished_.fetch_sub(count) == count) call_others();
}

// Until somebody calls, ends() or has_work(), which is asked once.
template <class HasWork, class Ends>
void WorkerTeam::watch(const HasWork& has_work, const Ends& ends) {
  ++watching_;
  const std::uint32_t seen = calls_.load();
  const auto changed = [&] { return ends() || calls_.load() != seen; };
  if (!has_work() && !ends() && !look_out(changed)) calls_.wait(seen);
  --watching_;
}

void WorkerTeam::work(int thread) {
  const auto has_work = [this] { return has_open() || !background_.is_empty(); };
  while (!stop_) {
    take_all(thread);
    if (!take_background()) watch(has_work, [this] { return stop_.load(); });
  }
}

void WorkerTeam::begin(BackgroundTask& task) {
  task.is_offered = threads_ > 1 && background_.offer(task);
  if (task.is_offered) call_others();
}

bool WorkerTeam::take_background() {
  is_in_task = true;
  const bool has_run = background_.run();
  is_in_task = false;
  if (has_run) call_others();
  return has_run;
}

// True where nobody has begun it, nor will; else it is done.
bool WorkerTeam::leave_out(BackgroundTask& task) {
  if (background_.withdraw(task)) return true;
  const auto is_done = [&task] { return task.is_done.load(); };
  while (!is_done()) watch([] { return false; }, is_done);
  return false;
}

void WorkerTeam::finish(BackgroundTask& task) {
  if (!task.work) return;
  const bool is_left_out = leave_out(task);
  const std::function<void()> work = std::exchange(task.work, nullptr);
  if (is_left_out) return work();
  if (task.failure) std::rethrow_exception(std::exchange(task.failure, nullptr));
}

void WorkerTeam::cancel(BackgroundTask& task) {
  if (task.work) leave_out(task);
  task.work = nullptr;
}

void WorkerTeam::begin_stage(int count, Task task, void* context) {
  task_ = task;
  context_ = context;
  failed_ = false;
  unfinished_.store(count);
}

// The caller works along and then waits for the tasks of others.
void WorkerTeam::finish_stage() {
  const auto all_done = [this] { return unfinished_.load() == 0; };
  const auto has_work = [this] { return has_open(); };
  call_others();
  for (take_all(0); !all_done(); take_all(0)) watch(has_work, all_done);
  if (failed_) std::rethrow_exception(std::exchange(failure_, nullptr));
}

void WorkerTeam::run(int count, Task task, void* context) {
  if (count <= 0) return;
  assert(!is_in_task);
  const std::scoped_lock lock(one_caller_);
  graph_ = nullptr;
  begin_stage(count, task, context);
  for (int k = 0, first = 0; k < threads_; ++k) {
    const int end = static_cast<int>((k + 1) * static_cast<std::int64_t>(count) / threads_);
    queues_[k].first = first;
    queues_[k].taken.store(0, std::memory_order_relaxed);
    queues_[k].open.store(end - first);  // in one order with `watching_`: see call_others
    first = end;
  }
  finish_stage();
}

// An entry; the right to take it follows.
WorkerTeam::Queue& WorkerTeam::enter(int task, bool has_waited) {
  Queue& queue = queues_[graph_->home(task, threads_) + (has_waited ? threads_ : 0)];
  queue.tasks[queue.listed.fetch_add(1, std::memory_order_relaxed)].store(task, std::memory_order_release);
  return queue;
}

// Tasks that waited for this one alone may start now.
void WorkerTeam::release_next(int task) {
  bool released = false;
  for (const int next : graph_->next(task)) {
    if (waits_[next].fetch_sub(1, std::memory_order_acq_rel) != 1) continue;
    enter(next, true).open.fetch_add(1);
    released = true;
  }
  if (released) call_others();
}

// Those that wait for none.
void WorkerTeam::list_first_tasks() {
  const int count = graph_->task_count();
  if (count > waits_capacity_) {
    waits_ = std::make_unique<std::atomic<int>[]>(count);
    waits_capacity_ = count;
  }
  first_tasks_.clear();
  std::ranges::fill(home_count_, 0);
  for (int i = 0; i < count; ++i) {
    waits_[i].store(graph_->wait_count(i), std::memory_order_relaxed);
    ++home_count_[graph_->home(i, threads_)];
    if (graph_->wait_count(i) == 0) first_tasks_.push_back(i);
  }
  for (int k = 0; k < 2 * threads_; ++k) {
    Queue& queue = queues_[k];
    const int most = home_count_[k % threads_];
    if (most > queue.capacity) {
      queue.tasks = std::make_unique<std::atomic<int>[]>(most);
      queue.capacity = most;
    }
    for (int i = 0; i < most; ++i) queue.tasks[i].store(-1, std::memory_order_relaxed);
    queue.taken.store(0, std::memory_order_relaxed);
    queue.listed.store(0, std::memory_order_relaxed);
  }
  if (shuffles()) std::ranges::shuffle(first_tasks_, std::mt19937_64(shuffle_seed_++));
}

void WorkerTeam::run(const TaskGraph& graph, Task task, void* context) {
  if (graph.task_count() == 0) return;
  assert(!is_in_task);
  const std::scoped_lock lock(one_caller_);
  graph_ = &graph;
  list_first_tasks();
  begin_stage(graph.task_count(), task, context);
  for (const int first : first_tasks_) enter(first, false);
  for (int k = 0; k < threads_; ++k) queues_[k].open.store(queues_[k].listed.load());
  finish_stage();
}

}  // namespace cleave
