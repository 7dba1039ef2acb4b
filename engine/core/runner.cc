#include "engine/core/runner.h"

#include <exception>
#include <utility>

#include "engine/base/str.h"

namespace vs {
namespace {

bool HasRequiredInputs(const Sequence::Node& node, const FrameInFlight& frame) {
  for (const Sequence::Input& input : node.inputs) {
    if (input.port->info().need == Need::kRequired && frame.slots[input.slot].empty()) return false;
  }
  return true;
}

void BindInputs(const Sequence::Node& node, const FrameInFlight& frame) {
  for (const Sequence::Input& input : node.inputs) {
    const Value& value = frame.slots[input.slot];
    const auto* integer = input.integer_to_number ? value.GetIf<int64_t>() : nullptr;
    input.port->Bind(integer == nullptr ? value : Value(static_cast<double>(*integer)));
  }
}

void ReleaseInputs(const Sequence::Node& node, FrameInFlight* frame) {
  for (const Sequence::Input& input : node.inputs) {
    input.port->Bind(Value());
    if (frame->readers_left[input.slot].fetch_sub(1, std::memory_order_acq_rel) == 1) {
      frame->slots[input.slot] = Value();
    }
  }
}

void CollectOutputs(const Sequence::Node& node, bool good, const Taps& taps, int64_t now_ns,
                    FrameInFlight* frame) {
  int slot = node.first_output_slot;
  for (PortBase* output : node.block->outputs()) {
    Value value = output->Release();
    if (good && !value.empty()) taps.Offer(slot, value, frame->context, now_ns);
    if (good && frame->readers_left[slot].load(std::memory_order_relaxed) > 0) {
      frame->slots[slot] = std::move(value);
    }
    ++slot;
  }
}

}  // namespace

FrameInFlight::FrameInFlight(const Sequence& sequence, std::shared_ptr<const RunInfo> run)
    : slots(sequence.slot_count()), readers_left(sequence.slot_count()) {
  context.run = std::move(run);
  context.block_times.resize(sequence.nodes().size());
}

void FrameInFlight::Begin(const Sequence& sequence, uint64_t number) {
  context.number = number;
  context.source_number = 0;
  context.capture_ns = 0;
  context.arrival_ns = 0;
  context.block_times.assign(context.block_times.size(), BlockTime());
  for (int slot = 0; slot < sequence.slot_count(); ++slot) {
    readers_left[slot].store(sequence.slot_readers()[slot], std::memory_order_relaxed);
  }
}

void FrameInFlight::Clear() {
  for (Value& value : slots) value = Value();
}

BlockOutcome RunBlock(Sequence::Node& node, int index, const Clock& clock, const Taps& taps,
                      FrameInFlight* frame) {
  BlockOutcome outcome;
  if (!HasRequiredInputs(node, *frame)) {
    outcome.kind = BlockOutcome::Kind::kSkipped;
    ReleaseInputs(node, frame);
    return outcome;
  }
  BindInputs(node, *frame);
  node.block->SetFrame(&frame->context);
  BlockTime& time = frame->context.block_times[index];
  const int64_t start_ns = clock.MonotonicNs();
  time.start_ns = start_ns;
  try {
    outcome.status = node.block->Run();
    if (!outcome.status.ok()) outcome.kind = BlockOutcome::Kind::kError;
  } catch (const std::exception& exception) {
    outcome.kind = BlockOutcome::Kind::kException;
    outcome.status = Internal(Str("exception: ", exception.what()));
  } catch (...) {
    outcome.kind = BlockOutcome::Kind::kException;
    outcome.status = Internal("exception of an unknown type");
  }
  const int64_t end_ns = clock.MonotonicNs();
  time.end_ns = end_ns;
  outcome.duration_ns = end_ns - start_ns;
  CollectOutputs(node, outcome.kind == BlockOutcome::Kind::kGood, taps, end_ns, frame);
  ReleaseInputs(node, frame);
  return outcome;
}

}  // namespace vs
