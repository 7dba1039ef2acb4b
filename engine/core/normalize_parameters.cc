#include "engine/core/normalize_parameters.h"

#include <map>
#include <string>
#include <utility>

#include "engine/core/block.h"

namespace vs {
namespace {

std::map<std::string, ParamValue> Normalized(const Block& type,
                                             const std::map<std::string, ParamValue>& params) {
  std::map<std::string, ParamValue> normalized;
  for (const auto& [name, value] : params) {
    const ParamBase* param = type.FindParam(name);
    ParamValue held = param == nullptr ? value : param->AsHeld(value);
    if (param == nullptr || held != param->info().initial) normalized[name] = std::move(held);
  }
  return normalized;
}

}  // namespace

void NormalizeParameters(SequenceSpec* spec) {
  for (BlockSpec& block : spec->blocks) {
    if (block.params.empty()) continue;
    const BlockRegistry::Entry* entry = BlockRegistry::Get().Find(block.type);
    if (entry != nullptr) block.params = Normalized(*entry->make(), block.params);
  }
}

}  // namespace vs
