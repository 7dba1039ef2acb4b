#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "engine/base/recycler.h"

namespace vs {

// When one block worked on one frame, host's monotonic clock; 0 until it happened.
struct BlockTime {
  int64_t start_ns = 0;
  int64_t end_ns = 0;
};

// What is the same for all frames of one run of a sequence.
struct RunInfo {
  std::string sequence;                // id of the sequence
  uint64_t sequence_revision = 0;      // of the stored specification
  std::vector<std::string> block_ids;  // in topological order
};

// The journey of one frame through one sequence. Blocks read it; the source sets the capture.
struct FrameContext {
  std::string sequence;             // id of the sequence
  uint64_t sequence_revision = 0;   // of the stored specification
  uint64_t number = 0;              // frames of this run, from 1, without gaps
  uint64_t source_number = 0;       // the source's own count; gaps are dropped or lost frames
  int64_t capture_ns = 0;           // exposure on the host's monotonic clock; 0 = no camera
  int64_t arrival_ns = 0;           // all pixels in memory
  int64_t popped_ns = 0;            // the source block took it
  uint64_t parameter_revision = 0;  // counts parameter changes since the start of the run
  uint64_t parameter_hash = 0;      // of all parameter values in effect, see Sequence
  std::vector<BlockTime, Recycler<BlockTime>> block_times;  // as RunInfo::block_ids
};

}  // namespace vs
