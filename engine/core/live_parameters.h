#pragma once

#include <atomic>
#include <cstdint>
#include <vector>

#include "engine/base/mutex.h"
#include "engine/base/status.h"
#include "engine/core/frame_context.h"
#include "engine/core/sequence.h"

namespace vs {

// The parameter values of a running sequence. A change is noted for the frame from which on it
// holds, and reaches each block when the block comes to that frame: so also with several frames in
// flight no frame sees half a change. Thread-safe.
class LiveParameters {
 public:
  explicit LiveParameters(Sequence* sequence);

  // All values, those of changes on their way included; as Sequence::Parameters().
  std::vector<ParamAssignment> Values() const;
  uint64_t Revision() const;

  // All faults of the batch at once: INVALID_ARGUMENT, or FAILED_PRECONDITION when it is only that
  // parameters are not live. What passes holds as long as nobody else changes something before it
  // is changed.
  Status Check(const std::vector<ParamAssignment>& batch) const;
  // Makes a checked batch hold from `first_frame` on, which has not been stamped.
  void Change(const std::vector<ParamAssignment>& batch, uint64_t first_frame);
  // Writes revision and hash of the values that hold for it into a frame that enters.
  void Stamp(FrameContext* frame) const;
  // Gives the block of this node what holds for this frame. Before each Run() of the block, on its
  // thread.
  void Apply(int node, uint64_t frame_number);

 private:
  struct Pending {
    ParamBase* param;
    ParamValue value;
    uint64_t first_frame;
  };
  struct PerNode {
    int first_value = 0;            // index in values_
    std::atomic<bool> any = false;  // pending is not empty
    std::vector<Pending> pending;   // in order of first_frame
  };

  // With the values in effect.
  BlockSpec BlockNow(int index) const;

  Sequence& sequence_;
  mutable Mutex mutex_;
  std::vector<PerNode> nodes_;  // their `pending` is guarded by mutex_
  std::vector<ParamAssignment> values_ VS_GUARDED_BY(mutex_);
  uint64_t revision_ VS_GUARDED_BY(mutex_) = 0;
  uint64_t hash_ VS_GUARDED_BY(mutex_);
};

}  // namespace vs
