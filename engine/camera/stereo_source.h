#pragma once

#include <functional>
#include <memory>

#include "engine/base/source_report.h"
#include "engine/base/status.h"
#include "engine/camera/camera_source.h"
#include "engine/camera/pairer.h"

namespace vs {

using StereoFramePtr = std::shared_ptr<const StereoFrame>;

// Takes each pair, on a thread of the source. May block a recorded source, must return at once for
// a live one.
using StereoSink = std::function<void(StereoFramePtr)>;

struct StereoStats {
  CameraStats left;
  CameraStats right;
  PairStats pairing;
};

// The problem of a camera, or why two good cameras make no pairs; and the figures of the pairing:
// how the partners were found, how far apart in time they are, and the unpaired pictures of each
// side by reason.
SourceReport ReportOf(const StereoStats& stats);

// Pairs of pictures of the same instant, from two cameras, from files or simulated. Calls are
// thread-safe.
class StereoSource {
 public:
  virtual ~StereoSource() = default;

  // Streams pairs, in order, into `sink` until Stop.
  virtual Status Start(StereoSink sink) = 0;
  // After it returns the sink is not called any more. A sink that waits must be let go first.
  virtual void Stop() = 0;
  virtual StereoStats Stats() const = 0;
  // Hands out every pair and waits for the consumer; false when live.
  virtual bool Recorded() const = 0;
};

// Two cameras of one rig. They must be triggered together; free-running cameras show different
// instants, which the skew in the statistics tells.
std::unique_ptr<StereoSource> MakeCameraPair(std::shared_ptr<CameraSource> left,
                                             std::shared_ptr<CameraSource> right,
                                             PairerOptions options = {});

}  // namespace vs
