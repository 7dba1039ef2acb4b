#include "engine/core/sequence_spec.h"

#include <algorithm>
#include <utility>

#include <nlohmann/json.hpp>

#include "engine/base/str.h"

namespace vs {

bool IsSequenceId(std::string_view text) {
  const auto lower = [](char c) { return c >= 'a' && c <= 'z'; };
  return !text.empty() && text.size() <= 63 && lower(text[0]) &&
         std::all_of(text.begin(), text.end(),
                     [&lower](char c) { return lower(c) || (c >= '0' && c <= '9') || c == '_'; });
}

Status CheckSequenceId(const std::string& text) {
  if (IsSequenceId(text)) return Status();
  return InvalidArgument(
      Str("must be a-z, 0-9 and _, begin with a letter and have at most 63 characters, not ",
          Quoted(text)));
}

std::string ToJson(const SequenceSpec& spec) {
  std::vector<const BlockSpec*> blocks;
  for (const BlockSpec& block : spec.blocks) blocks.push_back(&block);
  std::stable_sort(blocks.begin(), blocks.end(),
                   [](const BlockSpec* a, const BlockSpec* b) { return a->id < b->id; });
  std::vector<Connection> connections = spec.connections;
  std::sort(connections.begin(), connections.end());

  using nlohmann::json;
  json root = {{"id", spec.id},
               {"description", spec.description},
               {"priority", spec.priority},
               {"max_frames_in_flight", spec.max_frames_in_flight},
               {"blocks", json::array()},
               {"connections", json::array()}};
  if (spec.latency_budget_ms != 0) root["latency_budget_ms"] = spec.latency_budget_ms;
  for (const BlockSpec* block : blocks) {
    json params = json::object();
    for (const auto& [name, value] : block->params) {
      std::visit([&p = params[name]](const auto& held) { p = held; }, value);
    }
    root["blocks"].push_back({{"id", block->id},
                              {"type", block->type},
                              {"params", std::move(params)},
                              {"x", block->x},
                              {"y", block->y}});
  }
  for (const Connection& one : connections) {
    root["connections"].push_back(
        {{"from", one.from_block + "." + one.from_port}, {"to", one.to_block + "." + one.to_port}});
  }
  return root.dump(2, ' ', false, json::error_handler_t::replace) + "\n";
}

}  // namespace vs
