#pragma once

#include <cstdint>
#include <map>
#include <set>
#include <string>
#include <thread>

#include "engine/base/clock.h"
#include "engine/base/mutex.h"
#include "gpu/device_board.h"
#include "server/services/alarm_board.h"
#include "server/services/health_board.h"
#include "server/vision.h"

namespace vs {

// Looks after the vision half of a server twice a second: tells the health of each sequence
// ("sequences/ID"), and raises an alarm when results cannot be written ("results"), a sequence
// fails ("sequences/ID") or is over its latency budget for more than a second ("latency/ID"), a
// camera in use gives no pictures ("cameras/ID"), or a GPU in use does not work ("gpu/INDEX"). An
// alarm stays for some seconds after its reason has gone, so that what comes and goes is seen and
// fills no log.
class VisionWatch {
 public:
  // All must outlive it.
  VisionWatch(Vision& vision, const gpu::DeviceBoard& gpus, HealthBoard& health, AlarmBoard& alarms,
              const Clock& clock);
  ~VisionWatch();
  VisionWatch(const VisionWatch&) = delete;
  VisionWatch& operator=(const VisionWatch&) = delete;

 private:
  void Run() VS_EXCLUDES(mutex_);
  void Look();
  void LookAtSequences();
  void LookAtLatency(const SequenceStatus& status);
  void LookAtCameras();
  void LookAtGpus();
  void Report(const std::string& id, AlarmBoard::Severity severity, const std::string& message);
  void ClearOld();

  Vision& vision_;
  const gpu::DeviceBoard& gpus_;
  HealthBoard& health_;
  AlarmBoard& alarms_;
  const Clock& clock_;
  // Of the watching thread.
  std::map<std::string, int64_t> reported_ns_;  // when each raised alarm was last true
  std::set<std::string> known_;                 // names on the health board
  // Of a sequence with a latency budget: what was seen at the last look, and since when each look
  // has seen frames that were over it (0: the last one saw none).
  struct Latency {
    uint64_t frames = 0;
    uint64_t over_budget = 0;
    int64_t over_since_ns = 0;
  };
  std::map<std::string, Latency> latencies_;

  Mutex mutex_;
  CondVar changed_;
  bool closing_ VS_GUARDED_BY(mutex_) = false;
  std::jthread thread_;  // last: everything it uses exists before it starts
};

}  // namespace vs
