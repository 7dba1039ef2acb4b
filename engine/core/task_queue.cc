#include "engine/core/task_queue.h"

#include <algorithm>

namespace vs {
namespace {

bool ComesAfter(const Task& a, const Task& b) {
  if (a.priority != b.priority) return a.priority < b.priority;
  if (a.distance != b.distance) return a.distance > b.distance;
  return a.age > b.age;
}

}  // namespace

void TaskQueue::Push(const Task& task) {
  heap_.push_back(task);
  std::push_heap(heap_.begin(), heap_.end(), ComesAfter);
}

void TaskQueue::Kick() {
  if (sleeping_ > 0 && !heap_.empty()) available_.NotifyOne();
}

int TaskQueue::Remove(const ActiveRun* run) {
  const auto removed = std::erase_if(heap_, [run](const Task& task) { return task.run == run; });
  std::make_heap(heap_.begin(), heap_.end(), ComesAfter);
  return static_cast<int>(removed);
}

void TaskQueue::Reserve(size_t tasks) {
  room_ += tasks;
  heap_.reserve(room_);
}

bool TaskQueue::Take(Task* task) {
  MutexLock lock(mutex);
  while (heap_.empty() && !closed_) {
    ++sleeping_;
    available_.Wait(mutex);
    --sleeping_;
  }
  if (closed_) return false;
  std::pop_heap(heap_.begin(), heap_.end(), ComesAfter);
  *task = heap_.back();
  heap_.pop_back();
  Kick();
  return true;
}

void TaskQueue::Close() {
  MutexLock lock(mutex);
  closed_ = true;
  available_.NotifyAll();
}

}  // namespace vs
