#include "client/cli/sequence_text.h"

#include <algorithm>
#include <fstream>
#include <initializer_list>
#include <iostream>
#include <sstream>
#include <string_view>

#include <nlohmann/json.hpp>

#include "client/values.h"

namespace vs::cli {

namespace v1 = ::visionserver::v1;

namespace {

using client::Code;
using client::Failure;
using client::Result;
using nlohmann::json;

// What is wrong with the text and where; caught in SequenceFromJson.
struct Fault {
  std::string message;
};

json ToJson(const v1::Value& value) {
  switch (value.kind_case()) {
    case v1::Value::kBoolValue:
      return value.bool_value();
    case v1::Value::kIntValue:
      return value.int_value();
    case v1::Value::kDoubleValue:
      return value.double_value();
    case v1::Value::kStringValue:
      return value.string_value();
    default:
      return nullptr;
  }
}

v1::Value FromJson(const json& value, const std::string& place) {
  if (value.is_boolean()) return client::ToValue(value.get<bool>());
  if (value.is_number_integer()) return client::ToValue(value.get<int64_t>());
  if (value.is_number()) return client::ToValue(value.get<double>());
  if (value.is_string()) return client::ToValue(value.get<std::string>());
  throw Fault{place + " is no number, text, true or false"};
}

// An object of which every key is known.
const json& Object(const json& value, const std::string& place,
                   std::initializer_list<std::string_view> keys) {
  if (!value.is_object()) throw Fault{place + " is no object {...}"};
  for (const auto& [key, ignored] : value.items()) {
    if (std::find(keys.begin(), keys.end(), key) == keys.end()) {
      throw Fault{place + " has no \"" + key + "\""};
    }
  }
  return value;
}

std::string Text(const json& object, const char* key, const std::string& place, bool required) {
  const auto found = object.find(key);
  if (found == object.end()) {
    if (required) throw Fault{place + " lacks \"" + key + "\""};
    return {};
  }
  if (!found->is_string()) throw Fault{place + "." + key + " is no text"};
  return found->get<std::string>();
}

double Number(const json& object, const char* key, const std::string& place) {
  const auto found = object.find(key);
  if (found == object.end()) return 0;
  if (!found->is_number()) throw Fault{place + "." + key + " is no number"};
  return found->get<double>();
}

int Integer(const json& object, const char* key, const std::string& place) {
  const auto found = object.find(key);
  if (found == object.end()) return 0;
  if (!found->is_number_integer() || found->get<int64_t>() < -1'000'000 ||
      found->get<int64_t>() > 1'000'000) {
    throw Fault{place + "." + key + " is no whole number of a sensible size"};
  }
  return found->get<int>();
}

const json& List(const json& object, const char* key, const std::string& place) {
  static const json empty = json::array();
  const auto found = object.find(key);
  if (found == object.end()) return empty;
  if (!found->is_array()) throw Fault{place + "." + key + " is no list [...]"};
  return *found;
}

void ReadBlock(const json& value, const std::string& place, v1::BlockSpec* block) {
  Object(value, place, {"id", "type", "params", "x", "y"});
  block->set_id(Text(value, "id", place, true));
  block->set_type(Text(value, "type", place, true));
  block->set_x(Number(value, "x", place));
  block->set_y(Number(value, "y", place));
  if (!value.contains("params")) return;
  const json& params = value.at("params");
  if (!params.is_object()) throw Fault{place + ".params is no object {...}"};
  for (const auto& [name, param] : params.items()) {
    (*block->mutable_parameters())[name] = FromJson(param, place + ".params." + name);
  }
}

NamedSpec ReadSequence(const json& root) {
  const std::string place = "the sequence";
  Object(root, place,
         {"id", "description", "priority", "max_frames_in_flight", "latency_budget_ms", "blocks",
          "connections"});
  NamedSpec read;
  read.id = Text(root, "id", place, false);
  read.spec.set_description(Text(root, "description", place, false));
  read.spec.set_priority(Integer(root, "priority", place));
  read.spec.set_max_frames_in_flight(
      static_cast<uint32_t>(std::max(0, Integer(root, "max_frames_in_flight", place))));
  read.spec.set_latency_budget_ms(Number(root, "latency_budget_ms", place));
  const json& blocks = List(root, "blocks", place);
  for (size_t i = 0; i < blocks.size(); ++i) {
    ReadBlock(blocks[i], "blocks[" + std::to_string(i) + "]", read.spec.add_blocks());
  }
  const json& connections = List(root, "connections", place);
  for (size_t i = 0; i < connections.size(); ++i) {
    const std::string at = "connections[" + std::to_string(i) + "]";
    v1::Connection* connection = read.spec.add_connections();
    Object(connections[i], at, {"from", "to"});
    connection->set_from(Text(connections[i], "from", at, true));
    connection->set_to(Text(connections[i], "to", at, true));
  }
  return read;
}

}  // namespace

std::string SequenceToJson(const std::string& id, const v1::SequenceSpec& spec) {
  std::vector<v1::BlockSpec> blocks(spec.blocks().begin(), spec.blocks().end());
  std::stable_sort(blocks.begin(), blocks.end(),
                   [](const auto& a, const auto& b) { return a.id() < b.id(); });
  std::vector<v1::Connection> connections(spec.connections().begin(), spec.connections().end());
  std::stable_sort(connections.begin(), connections.end(), [](const auto& a, const auto& b) {
    return std::pair(a.from(), a.to()) < std::pair(b.from(), b.to());
  });
  json root = {{"id", id},
               {"description", spec.description()},
               {"priority", spec.priority()},
               {"max_frames_in_flight", spec.max_frames_in_flight()},
               {"blocks", json::array()},
               {"connections", json::array()}};
  if (spec.latency_budget_ms() != 0) root["latency_budget_ms"] = spec.latency_budget_ms();
  for (const v1::BlockSpec& block : blocks) {
    json params = json::object();
    for (const auto& [name, value] : block.parameters()) params[name] = ToJson(value);
    root["blocks"].push_back({{"id", block.id()},
                              {"type", block.type()},
                              {"params", std::move(params)},
                              {"x", block.x()},
                              {"y", block.y()}});
  }
  for (const v1::Connection& connection : connections) {
    root["connections"].push_back({{"from", connection.from()}, {"to", connection.to()}});
  }
  return root.dump(2, ' ', false, json::error_handler_t::replace) + "\n";
}

Result<NamedSpec> SequenceFromJson(const std::string& text) {
  try {
    return ReadSequence(json::parse(text));
  } catch (const json::parse_error& error) {
    // "[json.exception.parse_error.101] parse error at line 1, column 2: ...".
    const std::string what = error.what();
    return Failure(Code::kInvalidArgument, what.substr(what.find("] ") + 2));
  } catch (const Fault& fault) {
    return Failure(Code::kInvalidArgument, fault.message);
  }
}

Result<NamedSpec> ReadSequenceFile(const std::string& path) {
  std::ostringstream text;
  if (path == "-") {
    text << std::cin.rdbuf();
  } else {
    std::ifstream file(path);
    if (!file || !(text << file.rdbuf())) {
      return Failure(Code::kNotFound, "cannot read the sequence from " + path);
    }
  }
  Result<NamedSpec> read = SequenceFromJson(text.str());
  if (!read) read.error().message = path + ": " + read.error().message;
  return read;
}

}  // namespace vs::cli
