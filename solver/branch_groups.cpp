#include "solver/branch_groups.h"

#include <algorithm>
#include <numeric>

#include "solver/counting_sort.h"

namespace cleave {
namespace {

// In entries of the factor. A task has at least what takes a core about 4 microseconds on its way up, but on
// few bodies two threads still get three of them each; with more, the longest way counts more than what it
// costs to hand a task out: 16 workers would take a seventh longer with tasks of 3000 entries than with
// branches (modelled, 600 rocks). A supernode takes something besides its entries.
constexpr double kLeastWork = 8000, kTasksPerSquareOfThreads = 1.5, kSupernodeWork = 100;

double work_of(const BlockSymbolic& symbolic, const Branch& branch) {
  double work = 0;
  for (int i = branch.first; i <= branch.last; ++i) {
    const Supernode& s = symbolic.supernodes()[i];
    work += 36.0 * s.width * s.row_count + kSupernodeWork;
  }
  return work;
}

}  // namespace

bool BranchGroups::joins(const Branch& branch, int index) const {
  return branch.parent >= 0 && work_[index] < least_;
}

void BranchGroups::join(const BlockSymbolic& symbolic, int threads) {
  const auto branches = symbolic.branches();
  const int count = static_cast<int>(branches.size());
  work_.resize(count);
  for (int b = 0; b < count; ++b) work_[b] = work_of(symbolic, branches[b]);
  const double all = std::accumulate(work_.begin(), work_.end(), 0.0);
  least_ = threads > 1 ? std::min(kLeastWork, all / (kTasksPerSquareOfThreads * threads * threads)) : 0;
  for (int b = 0; b < count; ++b)
    if (joins(branches[b], b)) work_[branches[b].parent] += work_[b];
  number(branches);
  sort_into_buckets(
      count, group_count(), [this](int b) { return group_[b]; }, first_, branches_);
  list_tasks(symbolic);
}

// From the last branch down, then the other way round.
void BranchGroups::number(std::span<const Branch> branches) {
  group_.resize(branches.size());
  parent_.clear();
  for (int b = static_cast<int>(branches.size()) - 1; b >= 0; --b) {
    const int parent = branches[b].parent;
    group_[b] = joins(branches[b], b) ? group_[parent] : group_count();
    if (group_[b] == group_count()) parent_.push_back(parent < 0 ? -1 : group_[parent]);
  }
  const int last = group_count() - 1;
  for (int& group : group_) group = last - group;
  for (int& parent : parent_)
    if (parent >= 0) parent = last - parent;
  std::ranges::reverse(parent_);
}

void BranchGroups::list_tasks(const BlockSymbolic& symbolic) {
  const int last = 2 * group_count() - 1;
  waits_.clear();
  places_.clear();
  for (int g = 0; g < group_count(); ++g) places_.push_back(symbolic.branches()[branches(g).front()].place);
  for (int g = group_count() - 1; g >= 0; --g) {
    places_.push_back(places_[g]);
    waits_.emplace_back(g, parent_[g] >= 0 ? parent_[g] : last - g);
    if (parent_[g] >= 0) waits_.emplace_back(last - parent_[g], last - g);
  }
  graph_.build(2 * group_count(), waits_, places_);
}

// As if no branch were joined, so that what is refused does not depend on the number of threads: a branch has
// a group and its two tasks, which wait for one other each. Arrays that grow take up to twice their size.
void BranchGroups::count(MemoryCount& memory) const {
  const std::uint64_t branches = work_.size();
  constexpr int kIntsOfGroup = 4, kIntsOfTask = 3, kNumbersOfTask = 2, kTasks = 2, kGrown = 2;
  memory.add<int>(kGrown * (kIntsOfGroup + kTasks * kIntsOfTask), branches);
  memory.add<double>(kGrown * (1 + kTasks * kNumbersOfTask), branches);
  memory.add<std::pair<int, int>>(kGrown * kTasks, branches);
}

}  // namespace cleave
