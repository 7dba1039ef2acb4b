#pragma once

#include <cstdint>
#include <string>

#include "engine/base/recycler.h"
#include "engine/camera/clock_mapper.h"
#include "engine/camera/gev_frame_guard.h"
#include "engine/camera/gev_session.h"
#include "engine/camera/gev_stream.h"
#include "engine/image/frame.h"

namespace vs {

// Makes frames of what a stream gives: lets only whole, new pictures pass, numbers them, and puts
// their times on the host's clock. Lives as long as the camera is used, over all reconnects. For
// the device thread only.
class GevReceiver {
 public:
  struct Counters {
    uint64_t frames = 0;
    uint64_t incomplete = 0;
    uint64_t rejected_stale = 0;
    uint64_t lost = 0;
  };

  // Before the first picture of a new stream. `camera` is the name that frames carry.
  void Restart(const std::string& camera, GevSession& session);
  void SetExposure(double exposure_us) { exposure_us_ = exposure_us; }
  // Corrects for the drift of the clocks, about once a second.
  void SynchroniseClocks(GevSession& session);

  // Null when the picture must not be used; the counters tell why.
  FramePtr Take(GevPicture picture, int64_t arrival_ns);

  const Counters& counters() const { return counters_; }
  // Incomplete pictures since the last whole one.
  uint64_t incomplete_in_a_row() const { return incomplete_in_a_row_; }
  // What was wrong with the last incomplete picture.
  const std::string& problem() const { return problem_; }
  // The usual time between two pictures; 0 when unknown.
  int64_t period_ns() const { return period_ns_; }

 private:
  FramePtr MakeFrame(GevPicture picture, uint64_t number, int64_t arrival_ns);
  int64_t CaptureNs(const GevPicture& picture, int64_t arrival_ns);
  void NotePeriod(int64_t timestamp_ns, bool successor);

  std::string camera_;
  double exposure_us_ = 0;
  GevFrameGuard guard_;
  ClockMapper mapper_;
  bool clock_latches_ = false;  // the camera's clock can be read; else it is seen by its pictures
  int64_t last_timestamp_ns_ = 0;
  int64_t period_ns_ = 0;
  Counters counters_;
  uint64_t incomplete_in_a_row_ = 0;
  std::string problem_;
  Recycler<Frame> memory_;
};

}  // namespace vs
