#pragma once

#include <cstdint>

namespace vs {

// Decides when a streaming camera counts as stalled and when as lost. Plain logic on given times,
// all in ns of one monotonic clock. The receiver itself notices a dead camera only after some five
// seconds, by its heartbeat.
//
// A free-running camera stalls when no picture came for max(200 ms, 3 picture periods). Then it is
// asked, five times a second, whether it still answers; it is lost when it has not answered for
// 1.5 s, or has answered but sent nothing for 5 s. A triggered camera may be silent as long as it
// answers; it is asked once a second.
class GevWatchdog {
 public:
  enum class Action {
    kNone,
    kAsk,         // see whether the camera answers, then call Answered or NotAnswered
    kLostSilent,  // give up: it does not answer
    kLostIdle,    // give up: it answers but sends no pictures
  };

  // The stream was opened, or the camera was set differently. The next picture may take longer.
  // `period_ns` is the time between two pictures as far as the camera tells it, else 0.
  void Restart(int64_t now_ns, bool triggered, int64_t period_ns);
  // A picture came. `period_ns` is the usual time between two, 0 when unknown.
  void Picture(int64_t now_ns, int64_t period_ns);
  // Pictures come but there is no buffer for them.
  void Starving(int64_t now_ns) { Picture(now_ns, period_ns_); }

  Action Check(int64_t now_ns);
  void Answered(int64_t now_ns);
  void NotAnswered(int64_t now_ns);

  bool stalled() const { return stalled_; }
  // Before this time a silent camera is no surprise.
  int64_t quiet_until_ns() const { return quiet_until_ns_; }

 private:
  void Stall(int64_t now_ns);

  bool triggered_ = false;
  bool stalled_ = false;
  bool answering_ = true;
  int64_t period_ns_ = 0;
  int64_t quiet_until_ns_ = 0;
  int64_t stalled_since_ns_ = 0;
  int64_t ask_after_ns_ = 0;
};

}  // namespace vs
