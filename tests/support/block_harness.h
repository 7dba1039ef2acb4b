#pragma once

#include <map>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>

#include "engine/base/clock.h"
#include "engine/core/block.h"
#include "engine/core/environment.h"

namespace vs::test {

// Runs one block by itself, as the scheduler would: no ports of other blocks, no threads.
//
//   BlockHarness filter("SpeckleFilter");
//   ASSERT_TRUE(filter.Set("max_size_px", int64_t{10}).ok());
//   filter.Input("disparity", std::make_shared<const DisparityMap>(map));
//   ASSERT_TRUE(filter.Start().ok());
//   ASSERT_TRUE(filter.Run().ok());
//   const DisparityMap& filtered = *filter.Output<DisparityMap>("filtered");
class BlockHarness {
 public:
  explicit BlockHarness(const std::string& type) {
    const BlockRegistry::Entry* entry = BlockRegistry::Get().Find(type);
    if (entry == nullptr) throw std::invalid_argument("no block type " + type);
    block_ = entry->make();
    environment.clock = &clock_;
    frame.run = std::make_shared<const RunInfo>(RunInfo{"test_sequence", 1, {"block"}});
    frame.block_times.resize(1);
  }
  ~BlockHarness() { block_->Stop(); }
  BlockHarness(const BlockHarness&) = delete;
  BlockHarness& operator=(const BlockHarness&) = delete;

  // Fill in before Start() what the block needs.
  Environment environment;
  // The frame of the next Run(); its number is counted up by Run().
  FrameContext frame;

  Block& block() { return *block_; }

  Status Set(const std::string& param, const ParamValue& value) {
    ParamBase* found = block_->FindParam(param);
    return found == nullptr ? NotFound("no parameter " + param) : found->Set(value);
  }
  // Connects the input and gives it this value for all runs to come; an empty Value = no value.
  void Input(const std::string& port, Value value) {
    PortBase* input = block_->FindInput(port);
    if (input == nullptr) throw std::invalid_argument("no input " + port);
    if (!value.empty()) input->Connect(TypeName(value));
    inputs_[input] = std::move(value);
  }
  Status Start() {
    VS_RETURN_IF_ERROR(block_->CheckParams());
    block_->Attach(&environment, frame.run, [] {});
    return block_->Start();
  }
  Status Run() {
    ++frame.number;
    block_->SetFrame(&frame);
    for (const auto& [port, value] : inputs_) port->Bind(value);
    Status status = block_->Run();
    for (const auto& [port, value] : inputs_) port->Bind(Value());
    for (PortBase* output : block_->outputs()) outputs_[output->info().name] = output->Release();
    return status;
  }
  // What the last Run() set; empty when it set nothing.
  const Value& Output(const std::string& port) const { return outputs_.at(port); }
  // Null when the last Run() set nothing, or not a T.
  template <class T>
  const T* Output(const std::string& port) const {
    return Output(port).template GetIf<T>();
  }

 private:
  SystemClock clock_;
  std::unique_ptr<Block> block_;
  std::map<PortBase*, Value> inputs_;
  std::map<std::string, Value> outputs_;
};

}  // namespace vs::test
