#pragma once

#include <cstdint>

namespace vs {

// Tells new pictures of a GigE Vision camera from stale ones.
//
// A receiver that recycles its buffers can hand out an old picture as new: Aravis 0.8.26 does so,
// with its old frame id and status "success", when a leader announces a payload that it does not
// know. A robot must never be steered by such a picture, so both the frame id and the camera's time
// have to advance. Ids are 16 bits wide, skip 0 and wrap from 65535 to 1; cameras of GigE Vision 2
// may count in 64 bits.
class GevFrameGuard {
 public:
  struct Verdict {
    bool fresh = false;
    uint64_t number = 0;  // of a fresh frame: counts from 1, never repeats; a gap is lost frames
    uint64_t lost = 0;    // numbers skipped before this fresh frame
    bool clock_restarted = false;  // the camera's clock was set back: earlier times do not compare
  };

  // `frame_id` 0 is never fresh. `timestamp_ns` is the camera's own clock; 0 when it has none.
  Verdict Check(uint64_t frame_id, int64_t timestamp_ns);

  // The camera was opened anew: ids and clock start somewhere else, numbers go on.
  void Restart() { started_ = false; }

 private:
  bool started_ = false;
  uint64_t last_id_ = 0;
  int64_t last_timestamp_ns_ = 0;
  uint64_t last_number_ = 0;
  // A frame whose id advanced while its time went back. A second one like it means that the
  // camera's clock was reset.
  uint64_t doubtful_id_ = 0;
  int64_t doubtful_timestamp_ns_ = 0;
};

}  // namespace vs
