#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <vector>

#include "engine/base/clock.h"
#include "engine/base/status.h"
#include "engine/core/frame_context.h"
#include "engine/core/sequence.h"
#include "engine/core/taps.h"
#include "engine/core/value.h"

namespace vs {

// What a frame carries from block to block. Made once, used for one frame after the other.
struct FrameInFlight {
  FrameInFlight(const Sequence& sequence, std::shared_ptr<const RunInfo> run);
  // Makes it the next frame; all wires empty.
  void Begin(const Sequence& sequence, uint64_t number);
  // Lets go of all values. Not while a block runs.
  void Clear();

  FrameContext context;
  std::vector<Value> slots;
  // Inputs that still have to see the value of a slot. The last one frees it, so that memory and
  // camera buffers go back as early as possible.
  std::vector<std::atomic<int>> readers_left;
};

struct BlockOutcome {
  enum class Kind {
    kGood,
    kSkipped,    // a required input had no value: Run() was not called
    kError,      // Run() returned an error: no outputs
    kException,  // Run() threw
  };
  Kind kind = Kind::kGood;
  Status status;            // of kError and kException
  int64_t duration_ns = 0;  // of Run()
};

// Carries one frame through one block: takes the inputs from the frame's slots, runs and times the
// block, offers its outputs to the taps and puts them into their slots. Whoever calls it sees to
// the order. Thread-safe for different blocks.
BlockOutcome RunBlock(Sequence::Node& node, int index, const Clock& clock, const Taps& taps,
                      FrameInFlight* frame);

}  // namespace vs
