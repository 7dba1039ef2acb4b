#include "engine/core/live_parameters.h"

#include <algorithm>
#include <map>
#include <set>
#include <utility>

#include "engine/base/check.h"
#include "engine/base/str.h"
#include "engine/core/check_sequence.h"

namespace vs {

LiveParameters::LiveParameters(Sequence* sequence)
    : sequence_(*sequence),
      nodes_(sequence->nodes().size()),
      values_(sequence->Parameters()),
      hash_(HashParameters(values_)) {
  int first_value = 0;
  for (size_t i = 0; i < nodes_.size(); ++i) {
    nodes_[i].first_value = first_value;
    first_value += static_cast<int>(sequence->nodes()[i].block->params().size());
  }
}

std::vector<ParamAssignment> LiveParameters::Values() const {
  MutexLock lock(mutex_);
  return values_;
}

uint64_t LiveParameters::Revision() const {
  MutexLock lock(mutex_);
  return revision_;
}

Status LiveParameters::Check(const std::vector<ParamAssignment>& batch) const {
  std::vector<Fault> faults;
  bool only_not_live = true;
  std::set<std::string> seen;
  std::map<int, BlockSpec> changed;  // as they would be, with what does not fit too
  const auto refuse = [&](std::string subject, std::string message, bool not_live = false) {
    faults.push_back({std::move(subject), std::move(message)});
    only_not_live = only_not_live && not_live;
  };
  for (const ParamAssignment& one : batch) {
    const int node = sequence_.FindNode(one.block);
    if (node < 0) {
      refuse("sequence", Str("there is no block ", Quoted(one.block)));
      continue;
    }
    const ParamBase* param = sequence_.nodes()[node].block->FindParam(one.param);
    if (param == nullptr) {
      refuse(one.block, Str("there is no parameter ", Quoted(one.param)));
      continue;
    }
    const std::string subject = Str(one.block, ".", one.param);
    if (!seen.insert(subject).second) refuse(subject, "is set twice");
    const auto [block, is_new] = changed.try_emplace(node);
    if (is_new) block->second = BlockNow(node);
    block->second.params[one.param] = one.value;
    if (const Status status = param->Check(one.value); !status.ok()) {
      refuse(subject, status.message());
    } else if (!param->info().live) {
      refuse(subject, "can only change while the sequence is stopped", true);
    }
  }
  for (const auto& [node, block] : changed) {
    for (Fault& fault : CheckParamsTogether(block, sequence_.spec().connections)) {
      refuse(std::move(fault.subject), std::move(fault.message));
    }
  }
  if (faults.empty()) return Status();
  const size_t count = faults.size();
  return Status(
      only_not_live ? StatusCode::kFailedPrecondition : StatusCode::kInvalidArgument,
      Str("nothing was changed: ", count, count == 1 ? " value" : " values", " cannot be set"),
      std::move(faults));
}

BlockSpec LiveParameters::BlockNow(int index) const {
  const Sequence::Node& node = sequence_.nodes()[index];
  BlockSpec block{node.id, node.type, {}};
  MutexLock lock(mutex_);
  for (size_t i = 0; i < node.block->params().size(); ++i) {
    const ParamAssignment& one = values_[nodes_[index].first_value + i];
    block.params[one.param] = one.value;
  }
  return block;
}

void LiveParameters::Change(const std::vector<ParamAssignment>& batch, uint64_t first_frame) {
  MutexLock lock(mutex_);
  for (const ParamAssignment& one : batch) {
    const int index = sequence_.FindNode(one.block);
    const std::vector<ParamBase*>& params = sequence_.nodes()[index].block->params();
    const auto place = std::find_if(params.begin(), params.end(), [&](const ParamBase* param) {
      return param->info().name == one.param;
    });
    VS_CHECK(place != params.end());
    PerNode& node = nodes_[index];
    values_[node.first_value + (place - params.begin())].value = (*place)->AsHeld(one.value);
    // Many changes before one frame, perhaps while no frame comes, take the place of one.
    const auto same =
        std::find_if(node.pending.begin(), node.pending.end(), [&](const Pending& pending) {
          return pending.param == *place && pending.first_frame == first_frame;
        });
    if (same != node.pending.end()) {
      same->value = one.value;
    } else {
      node.pending.push_back({*place, one.value, first_frame});
      node.any.store(true, std::memory_order_relaxed);
    }
  }
  ++revision_;
  hash_ = HashParameters(values_);
}

void LiveParameters::Stamp(FrameContext* frame) const {
  MutexLock lock(mutex_);
  frame->parameter_revision = revision_;
  frame->parameter_hash = hash_;
}

void LiveParameters::Apply(int index, uint64_t frame_number) {
  PerNode& node = nodes_[index];
  // A change that this frame must see was noted before the frame entered.
  if (!node.any.load(std::memory_order_relaxed)) return;
  MutexLock lock(mutex_);
  const auto end = std::find_if(
      node.pending.begin(), node.pending.end(),
      [frame_number](const Pending& pending) { return pending.first_frame > frame_number; });
  for (auto one = node.pending.begin(); one != end; ++one) {
    const Status status = one->param->Set(one->value);
    VS_CHECK(status.ok());
  }
  node.pending.erase(node.pending.begin(), end);
  node.any.store(!node.pending.empty(), std::memory_order_relaxed);
}

}  // namespace vs
