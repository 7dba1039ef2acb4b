#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "engine/base/source_report.h"
#include "engine/base/status.h"
#include "engine/camera/camera_uri.h"
#include "engine/image/frame.h"

namespace vs {

// A GenICam feature's value. Enumerations are strings; a command takes and gives `true`.
using FeatureValue = std::variant<bool, int64_t, double, std::string>;

// What a camera says about one of its features. Names are GenICam's (SFNC: Width, ExposureTime ...)
// or the brand's own (ExposureTimeAbs).
struct FeatureInfo {
  enum class Type { kBoolean, kInteger, kFloat, kString, kEnumeration, kCommand };

  std::string name;
  Type type = Type::kString;
  std::string unit;         // as the camera words it, empty if it says none
  std::string description;  // the camera's own tool tip
  bool writable = false;    // at this moment
  std::optional<double> min;
  std::optional<double> max;
  std::vector<std::string> choices;  // of an enumeration
};

// Closed -> Opening -> Streaming <-> Stalled -> Lost -> Opening ...
enum class CameraState {
  kClosed,
  kOpening,  // connecting, waiting for control, or configuring; tries again by itself
  kIdle,     // open, not streaming
  kStreaming,
  kStalled,  // no picture for longer than the watchdog allows
  kLost,     // gone; will be opened again
};
std::string_view CameraStateName(CameraState state);

struct CameraStats {
  CameraState state = CameraState::kClosed;
  std::string last_error;        // in words with the remedy; empty when all is well
  uint64_t frames = 0;           // delivered whole
  uint64_t incomplete = 0;       // arrived with packets missing, not delivered
  uint64_t rejected_stale = 0;   // claimed to be new but were not (frame id or time ran back)
  uint64_t lost = 0;             // numbers missing between delivered frames, for any reason
  uint64_t underruns = 0;        // times that no buffer was free: pictures were held downstream
  uint64_t resend_requests = 0;  // packets asked for again
  uint64_t resent = 0;           // packets that came again
  uint64_t reconnects = 0;
  int socket_buffer_asked_bytes = 0;
  int socket_buffer_got_bytes = 0;  // what the system really granted
  int packet_bytes = 0;
  double frames_per_second = 0;  // over the last second
  std::string model;             // vendor and model, once known
  std::string serial;
};

// The camera's problem, and how many of its pictures came or did not.
SourceReport ReportOf(const CameraStats& stats);

// Takes each picture, on the camera's own thread. May block a recorded source (so that no picture
// is lost), must return at once for a live one.
using FrameSink = std::function<void(FramePtr)>;

// One camera. A driver implements it and registers under a URI scheme with VS_REGISTER_CAMERA.
//
// Calls are thread-safe and never wait for a dead camera: what needs the device is done by the
// camera's own thread. Pictures of one camera arrive in order, whole, each exactly once.
class CameraSource {
 public:
  virtual ~CameraSource() = default;

  // Opens the camera if necessary and streams into `sink` until Stop. A camera that is not there
  // (yet, or any more) is not an error: the driver keeps trying and says so in Stats. Errors: the
  // URI's options make no sense.
  virtual Status Start(FrameSink sink) = 0;
  // After it returns the sink is not called any more. A sink that waits must be let go first.
  virtual void Stop() = 0;
  // Takes one picture now; FAILED_PRECONDITION unless the camera is set to software trigger.
  virtual Status Trigger() = 0;

  virtual Result<std::vector<FeatureInfo>> Features() = 0;
  virtual Result<FeatureValue> GetFeature(const std::string& name) = 0;
  // The value that the camera reads back, which may be rounded. Values set here are set again
  // after a reconnect.
  virtual Result<FeatureValue> SetFeature(const std::string& name, const FeatureValue& value) = 0;

  virtual CameraStats Stats() const = 0;
  // A recorded source that hands out every picture (see Mailbox::Policy::kEvery); false when live.
  virtual bool Recorded() const { return false; }
};

using CameraFactory = std::function<Result<std::unique_ptr<CameraSource>>(const CameraUri&)>;

// The drivers, by URI scheme. Filled while the program starts, read-only afterwards.
class CameraDrivers {
 public:
  static CameraDrivers& Get();
  bool Add(std::string scheme, CameraFactory factory);
  std::vector<std::string> Schemes() const;
  // Makes the camera without opening it. NOT_FOUND names the schemes that there are.
  Result<std::unique_ptr<CameraSource>> Make(const CameraUri& uri) const;

 private:
  std::map<std::string, CameraFactory> factories_;
};

// The last line of a driver's file; also for two schemes of one driver.
#define VS_REGISTER_CAMERA(scheme, factory)                                              \
  [[maybe_unused]] static const bool VS_CONCAT_(kCameraDriverRegistered_, __COUNTER__) = \
      ::vs::CameraDrivers::Get().Add(scheme, factory)

}  // namespace vs
