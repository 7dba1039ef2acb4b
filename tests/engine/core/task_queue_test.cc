#include "engine/core/task_queue.h"

#include <gtest/gtest.h>

#include <atomic>
#include <thread>
#include <vector>

namespace vs {
namespace {

// Tells tasks apart by their node.
Task Make(int node, int priority, int distance, uint64_t age, ActiveRun* run = nullptr) {
  return {run, node, nullptr, priority, distance, age};
}

void PushAll(TaskQueue* queue, const std::vector<Task>& tasks) {
  MutexLock lock(queue->mutex);
  for (const Task& task : tasks) queue->Push(task);
}

std::vector<int> TakeAll(TaskQueue* queue, int count) {
  std::vector<int> nodes;
  Task task;
  for (int i = 0; i < count && queue->Take(&task); ++i) nodes.push_back(task.node);
  return nodes;
}

TEST(TaskQueue, PrefersPriorityThenTheOutputThenAgeAndEntersLast) {
  TaskQueue queue;
  PushAll(&queue, {Make(Task::kEntry, 0, Task::kLast, 1), Make(1, 0, 2, 5), Make(2, 0, 2, 4),
                   Make(3, 0, 0, 9), Make(4, -1, 0, 0), Make(5, 1, 7, 9)});
  EXPECT_EQ(TakeAll(&queue, 6), (std::vector<int>{5, 3, 2, 1, Task::kEntry, 4}));
}

TEST(TaskQueue, ForgetsTheTasksOfOneRun) {
  TaskQueue queue;
  auto* run = reinterpret_cast<ActiveRun*>(&queue);  // only its address counts
  PushAll(&queue,
          {Make(1, 0, 3, 1), Make(2, 0, 2, 1, run), Make(3, 0, 1, 1), Make(4, 9, 0, 1, run)});
  {
    MutexLock lock(queue.mutex);
    EXPECT_EQ(queue.Remove(run), 2);
  }
  EXPECT_EQ(TakeAll(&queue, 2), (std::vector<int>{3, 1}));
}

TEST(TaskQueue, WakesWaitingWorkersForTasksAndForTheEnd) {
  TaskQueue queue;
  std::atomic<int> taken = 0;
  std::vector<std::thread> workers;
  workers.reserve(3);
  for (int i = 0; i < 3; ++i) {
    workers.emplace_back([&] {
      Task task;
      while (queue.Take(&task)) ++taken;
    });
  }
  for (int i = 0; i < 100; ++i) {
    MutexLock lock(queue.mutex);
    queue.Push(Make(i, 0, 0, i));
    queue.Push(Make(i, 0, 0, i));
    queue.Kick();
  }
  while (taken < 200) std::this_thread::yield();
  queue.Close();
  for (std::thread& worker : workers) worker.join();
  EXPECT_EQ(taken, 200);
}

}  // namespace
}  // namespace vs
