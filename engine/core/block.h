#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "engine/base/source_report.h"
#include "engine/base/status.h"
#include "engine/core/environment.h"
#include "engine/core/frame_context.h"
#include "engine/core/param.h"
#include "engine/core/port.h"
#include "engine/core/registry.h"
#include "engine/image/buffer.h"

namespace vs {

// One step of a sequence. Ports and parameters are declared as members and so describe
// themselves; an engineer's whole work on a block is one file that ends in VS_REGISTER_BLOCK.
//
// A block is cheap to construct: the registry makes one just to describe it. Files, cameras and
// memory are taken in Start(). Never called by two threads at once; one frame after the other, in
// order. An error of Run() ends this frame in this branch, is counted and shown; the next frame is
// tried again. An exception ends the run of the sequence.
class Block {
 public:
  Block() = default;
  virtual ~Block() = default;
  Block(const Block&) = delete;
  Block& operator=(const Block&) = delete;

  // What is wrong with the parameters when taken together, though each fits by itself: a limit
  // above its counterpart. Of their values and connected() alone: asked of a block that is never
  // started, whenever somebody proposes values, so Start() and Run() only see such that passed.
  // Faults, if any, have the names of parameters as subjects.
  virtual Status CheckParams() const { return Status(); }
  // Before the first frame, parameters set. An error keeps the sequence from starting.
  virtual Status Start() { return Status(); }
  // One frame: reads inputs and parameters, sets outputs.
  virtual Status Run() = 0;
  // After the last frame, also when Start() failed or was never called. Must end waits.
  virtual void Stop() {}
  // Of a source (a block without connected inputs): is there something to run for? Asked again
  // after each frame and after each Wake(), so a source whose answer changes to true on another
  // thread must call Wake().
  virtual bool Ready() { return true; }
  // Of a source: pictures that never entered the sequence because it was busy. Thread-safe.
  virtual uint64_t Dropped() const { return 0; }
  // Of a source: whether pictures come, and if not, why. Empty before Start() and after Stop().
  // Thread-safe.
  virtual SourceReport Report() const { return {}; }

  const std::vector<PortBase*>& inputs() const { return inputs_; }
  const std::vector<PortBase*>& outputs() const { return outputs_; }
  const std::vector<ParamBase*>& params() const { return params_; }
  // Null when there is none of that name.
  ParamBase* FindParam(std::string_view name) const;
  PortBase* FindInput(std::string_view name) const;
  PortBase* FindOutput(std::string_view name) const;

  // For whoever runs the block: before Start(). `environment` must outlive the block's Stop().
  void Attach(const Environment* environment, std::shared_ptr<const RunInfo> run,
              std::function<void()> wake);
  // For whoever runs the block: before each Run().
  void SetFrame(FrameContext* frame) { frame_ = frame; }

 protected:
  const Environment& environment() const { return *environment_; }
  // The run that this block is part of, from Start() on.
  const RunInfo& run() const { return *run_; }
  // The frame that Run() is working on. Only a source writes it: the capture fields.
  FrameContext& frame() const { return *frame_; }
  // Memory for outputs, recycled from earlier frames: Image<uint16_t> out(pool(), width, height).
  BufferPool& pool() { return pool_; }
  // Of a source: Ready() may have become true. From any thread, between Start() and Stop().
  void Wake() const {
    if (wake_) wake_();
  }

 private:
  friend class ParamBase;
  friend class PortBase;

  std::vector<PortBase*> inputs_;
  std::vector<PortBase*> outputs_;
  std::vector<ParamBase*> params_;
  const Environment* environment_ = nullptr;
  std::shared_ptr<const RunInfo> run_;
  FrameContext* frame_ = nullptr;
  std::function<void()> wake_;
  BufferPool pool_;
};

}  // namespace vs
