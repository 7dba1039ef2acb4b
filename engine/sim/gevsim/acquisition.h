#pragma once

#include <atomic>
#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <thread>

#include "engine/base/mutex.h"
#include "engine/image/buffer.h"
#include "engine/sim/device_clock.h"
#include "engine/sim/gevsim/faults.h"
#include "engine/sim/gevsim/register_addresses.h"
#include "engine/sim/gevsim/registers.h"
#include "engine/sim/gevsim/stream_sender.h"
#include "engine/sim/picture_source.h"

namespace vs::sim {

// Takes pictures when they are due and sends them, on a thread of its own. Unlike a real sensor it
// needs no time for it: a picture shows its trigger's instant and is sent at once, however long the
// exposure time, which only makes it brighter.
class Acquisition {
 public:
  struct Settings {
    DeviceClock clock;
    double link_mbps = 1000;
    uint16_t first_block_id = 1;
  };

  Acquisition(const Settings& settings, Registers& registers, PictureSource& pictures,
              StreamSender& sender, Faults& faults);
  ~Acquisition();

  // From any thread. Start begins (free-running or waiting for triggers, as the registers say);
  // after Stop a picture that has been taken is still sent whole.
  void Start();
  void Stop();
  // A client has opened a new stream: block ids begin again.
  void RestartBlockIds();
  // Takes a picture at `instant_ns` (monotonic clock, not far in the future) if the camera waits
  // for triggers of this source.
  void Trigger(TriggerSource source, int64_t instant_ns);

  // Pictures that were not taken: the camera was still busy with earlier ones, or frozen.
  uint64_t MissedTriggers() const { return missed_triggers_; }

 private:
  void Run();
  // The instant of the next picture, or nothing if it is not time yet or acquisition has stopped.
  std::optional<int64_t> NextInstant() VS_EXCLUDES(mutex_);
  bool TriggerOn(TriggerSource source) const;
  bool FreeRunning() const;
  void TakePicture(int64_t instant_ns);

  const Settings settings_;
  Registers& registers_;
  PictureSource& pictures_;
  StreamSender& sender_;
  Faults& faults_;
  BufferPool pool_;
  std::atomic<uint64_t> missed_triggers_ = 0;
  std::atomic<uint64_t> frames_ = 0;
  std::atomic<uint16_t> block_id_;  // of the next frame
  std::atomic<bool> halt_ = false;  // cuts off what is being sent

  Mutex mutex_;
  CondVar changed_;
  bool quit_ VS_GUARDED_BY(mutex_) = false;
  bool running_ VS_GUARDED_BY(mutex_) = false;
  std::deque<int64_t> triggers_ VS_GUARDED_BY(mutex_);
  int64_t next_free_run_ns_ VS_GUARDED_BY(mutex_) = 0;
  std::thread thread_;
};

}  // namespace vs::sim
