#pragma once

#include <atomic>
#include <chrono>
#include <memory>
#include <string>
#include <thread>

#include "engine/base/clock.h"
#include "engine/base/mutex.h"
#include "engine/camera/camera_source.h"
#include "engine/camera/device_calls.h"
#include "engine/camera/feature_memory.h"
#include "engine/camera/gev_receiver.h"
#include "engine/camera/gev_session.h"
#include "engine/camera/gev_watchdog.h"
#include "engine/camera/gvcp.h"

namespace vs {

// How to reach a GigE Vision camera and what to set on it, from its URI.
struct GevCameraOptions {
  std::string uri;      // for messages
  std::string serial;   // empty: by address
  std::string address;  // empty: by serial number
  CameraUri::Options features;
  GevStreamOptions stream;
  int packet_bytes = 0;  // 0 = automatic
};

// A GigE Vision camera and the one thread that ever touches it: opens it when it is needed, sets it
// up, hands on its pictures, notices when it stalls or is lost, and opens it again.
class GevDevice {
 public:
  using Calls = DeviceCalls<GevDevice>;

  explicit GevDevice(GevCameraOptions options);
  // Gives the camera back, or gives it up when it is gone; either takes about a second at most,
  // unless the camera goes during a call to it.
  ~GevDevice();
  GevDevice(const GevDevice&) = delete;
  GevDevice& operator=(const GevDevice&) = delete;

  // For any thread.
  Status Start(FrameSink sink);
  void Stop();
  CameraStats Stats() const;
  Calls& calls() { return calls_; }

  // For the steps of calls, which run on the device thread while the camera is open.
  GevFeatures& features() { return session_->features(); }
  // Stops the stream for the moment where the camera demands it.
  Result<FeatureValue> SetFeature(const std::string& name, const FeatureValue& value);
  Status SoftwareTrigger() { return session_->SoftwareTrigger(); }

 private:
  void Run();
  bool Needed() const { return streaming_wanted_ || calls_.Waiting(); }
  void LogProblem(const std::string& problem);
  void SleepUnlessQuit(std::chrono::milliseconds duration);

  Status Open();
  Result<FoundCamera> Locate();
  Status AwaitControl();
  // Until the camera is lost (then: why), or this object goes: a camera that was opened, if only
  // for one call, stays ours as long as somebody holds it.
  Status Serve();
  Status BeginStream();
  void EndStream();
  void Close();
  void AbandonIfGone();
  Status Receive();
  Status Watch(int64_t now_ns);
  Status Ask(int64_t now_ns);
  void NoteSettings();
  void CountPictures();
  void CountStream();
  void KeepHouse(int64_t now_ns);
  void SynchroniseClocks(int64_t now_ns);
  void CheckSocketBuffer();

  void SetState(CameraState state, const std::string& problem);
  CameraState state() const;

  const GevCameraOptions options_;
  const SystemClock clock_;
  Calls calls_;
  std::atomic<bool> quit_ = false;
  std::atomic<bool> streaming_wanted_ = false;

  Mutex sink_mutex_;  // held while the sink runs
  FrameSink sink_ VS_GUARDED_BY(sink_mutex_);

  mutable Mutex stats_mutex_;
  CameraStats stats_ VS_GUARDED_BY(stats_mutex_);
  // When a stalled camera is noticed even if the device thread hangs in a call to it.
  int64_t stall_ns_ VS_GUARDED_BY(stats_mutex_) = 0;

  // Of the device thread alone.
  std::unique_ptr<GevSession> session_;
  FoundCamera camera_;  // who it is and where it was last
  FeatureMemory memory_;
  GevReceiver receiver_;
  GevWatchdog watchdog_;
  GevStreamCounters counted_;  // of the open stream, contained in stats_
  bool starving_ = false;
  bool socket_checked_ = false;  // of the open stream
  bool socket_warned_ = false;
  bool small_packets_ = false;  // large ones do not get through
  bool opened_before_ = false;
  int refusals_ = 0;  // in a row: another program had control
  std::string logged_problem_;
  int64_t next_synchronisation_ns_ = 0;
  int64_t next_housekeeping_ns_ = 0;
  int64_t last_housekeeping_ns_ = 0;
  uint64_t last_frames_ = 0;

  std::thread thread_;
};

}  // namespace vs
