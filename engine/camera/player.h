#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <functional>
#include <thread>

#include "engine/base/mutex.h"

namespace vs {

// How a recording is played.
struct PlayOptions {
  double fps = 0;     // pictures a second; 0 = as fast as they are taken
  bool loop = false;  // begin again after the last one
};

// Steps through a recording at a given rate on a thread of its own.
class Player {
 public:
  // Shows the item at `index`. `number` counts from 1 and goes on in a loop. False ends the play.
  using Show = std::function<bool(size_t index, uint64_t number)>;

  Player() = default;
  ~Player() { Stop(); }
  Player(const Player&) = delete;
  Player& operator=(const Player&) = delete;

  // Not while it plays.
  void Start(size_t count, const PlayOptions& options, Show show);
  // Waits for the end of a Show that is running.
  void Stop();
  bool Playing() const { return playing_; }

 private:
  void Run(size_t count, const PlayOptions& options, const Show& show);
  // False when it was stopped meanwhile.
  bool WaitUntil(std::chrono::steady_clock::time_point due);

  Mutex mutex_;
  CondVar stopped_;
  bool stop_ VS_GUARDED_BY(mutex_) = false;
  std::atomic<bool> playing_ = false;
  std::thread thread_;
};

}  // namespace vs
