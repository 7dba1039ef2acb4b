#include "engine/core/block.h"

#include <utility>

namespace vs {
namespace {

template <class T>
T* FindByName(const std::vector<T*>& all, std::string_view name) {
  for (T* one : all) {
    if (one->info().name == name) return one;
  }
  return nullptr;
}

}  // namespace

PortBase::PortBase(Block* owner, PortInfo info) : info_(std::move(info)) {
  (info_.output ? owner->outputs_ : owner->inputs_).push_back(this);
}

bool PortTypesFit(std::string_view from, std::string_view to) {
  return from == to || to == PortType<Value>::kName ||
         (from == PortType<int64_t>::kName && to == PortType<double>::kName);
}

ParamBase::ParamBase(Block* owner, ParamInfo info) : info_(std::move(info)) {
  owner->params_.push_back(this);
}

ParamBase* Block::FindParam(std::string_view name) const { return FindByName(params_, name); }
PortBase* Block::FindInput(std::string_view name) const { return FindByName(inputs_, name); }
PortBase* Block::FindOutput(std::string_view name) const { return FindByName(outputs_, name); }

void Block::Attach(const Environment* environment, std::shared_ptr<const RunInfo> run,
                   std::function<void()> wake) {
  environment_ = environment;
  run_ = std::move(run);
  wake_ = std::move(wake);
}

}  // namespace vs
