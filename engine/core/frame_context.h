#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "engine/base/recycler.h"

namespace vs {

// Nanoseconds that one thread writes while others may be copying them; a copy is the old or the new
// value. Reads and writes like an int64_t.
class SharedNs {
 public:
  SharedNs(int64_t ns = 0) : ns_(ns) {}  // NOLINT(google-explicit-constructor)
  SharedNs(const SharedNs& other) : ns_(static_cast<int64_t>(other)) {}
  SharedNs& operator=(const SharedNs& other) { return *this = static_cast<int64_t>(other); }
  SharedNs& operator=(int64_t ns) {
    ns_.store(ns, std::memory_order_relaxed);
    return *this;
  }
  operator int64_t() const {  // NOLINT(google-explicit-constructor)
    return ns_.load(std::memory_order_relaxed);
  }

 private:
  std::atomic<int64_t> ns_;
};

// When one block worked on one frame, host's monotonic clock; 0 until it happened.
struct BlockTime {
  SharedNs start_ns;
  SharedNs end_ns;
};

// What is the same for all frames of one run of a sequence.
struct RunInfo {
  std::string sequence;                // id of the sequence
  uint64_t sequence_revision = 0;      // of the stored specification
  std::vector<std::string> block_ids;  // in topological order
};

// The journey of one frame through one sequence. Blocks read it; a source sets the capture (of
// several sources the last one in topological order has the last word). Copying a frame of a warm
// sequence takes nothing from the heap.
struct FrameContext {
  std::shared_ptr<const RunInfo> run;  // never null
  uint64_t number = 0;                 // frames of this run, from 1, without gaps
  uint64_t source_number = 0;          // the source's own count; gaps are dropped or lost frames
  int64_t capture_ns = 0;              // exposure on the host's monotonic clock; 0 = no camera
  int64_t arrival_ns = 0;              // all pixels in memory
  int64_t popped_ns = 0;               // the frame entered the sequence (set by the scheduler)
  uint64_t parameter_revision = 0;     // counts parameter changes since the start of the run
  uint64_t parameter_hash = 0;         // of all parameter values in effect, see HashParameters
  std::vector<BlockTime, Recycler<BlockTime>> block_times;  // as RunInfo::block_ids
};

}  // namespace vs
