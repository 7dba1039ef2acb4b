#pragma once

#include <arv.h>

#include <atomic>
#include <cstdint>
#include <initializer_list>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "engine/base/status.h"
#include "engine/camera/camera_uri.h"
#include "engine/camera/feature_memory.h"
#include "engine/camera/gev_features.h"
#include "engine/camera/gev_glib.h"
#include "engine/camera/gev_sockets.h"
#include "engine/camera/gev_stream.h"

namespace vs {

// One connection to a camera, from taking control to giving it back. Used by the device thread
// only; nearly every call talks to the camera and takes seconds when the camera is gone.
class GevSession {
 public:
  // A moment on both clocks.
  struct ClockSample {
    int64_t device_ns = 0;
    int64_t host_ns = 0;  // monotonic, at most one round trip late
  };

  // Takes control of the camera. FAILED_PRECONDITION when another program has it.
  static Result<std::unique_ptr<GevSession>> Open(const std::string& address);
  ~GevSession();
  GevSession(const GevSession&) = delete;
  GevSession& operator=(const GevSession&) = delete;

  // A known state (continuous, free-running, 8-bit grey), then the URI's features, then those that
  // were set since. What the URI sets is remembered, too, but not twice.
  Status Configure(const CameraUri::Options& features, const FeatureMemory& memory);

  // Packets of `packet_bytes`; 0 = as large as the network allows, at most 8192.
  Status StartStream(const GevStreamOptions& options, int packet_bytes);
  void StopStream();
  GevStream* stream() { return stream_.get(); }
  int packet_bytes() const { return packet_bytes_; }

  GevFeatures& features() { return features_; }
  // Pictures come only when something triggers them.
  bool Triggered() const;
  Status SoftwareTrigger();
  double ExposureUs() const;  // 0 when unknown or automatic
  // Between two pictures of the free-running camera; 0 when it does not tell.
  int64_t ExpectedPeriodNs() const;
  // The size of a picture differs from what the open stream expects.
  bool PayloadChanged() const;
  // Reads both clocks; nullopt when the camera cannot latch its clock.
  std::optional<ClockSample> SampleClock();

  // For a camera that is gone: from now on all calls fail within half a second, where Aravis would
  // try for seconds, so that the session can be closed. It is good for nothing else.
  void Abandon();
  bool abandoned() const { return abandoned_; }

  // The camera was taken by another program, or restarted.
  bool control_lost() const { return control_lost_; }

 private:
  // The first of these features that the camera has; 0 when it has none.
  double FirstOf(std::initializer_list<const char*> names) const;
  GevSession(GObjectPtr<ArvDevice> device, std::string address, std::vector<UdpSocket> opened);
  Status SetPacketSize(int packet_bytes);
  // Sets what exists and can be written now.
  Status SetIfPossible(const std::string& name, const std::string& text);

  std::atomic<bool> control_lost_ = false;
  GObjectPtr<ArvDevice> device_;
  const std::string address_;
  std::vector<UdpSocket> opened_;  // with the device; its control socket is among them
  bool abandoned_ = false;
  GevFeatures features_;
  int packet_bytes_ = 0;
  uint64_t tick_hz_ = 0;
  std::unique_ptr<GevStream> stream_;
};

}  // namespace vs
