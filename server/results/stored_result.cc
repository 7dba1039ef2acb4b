#include "server/results/stored_result.h"

#include <array>
#include <cstdio>
#include <type_traits>
#include <utility>

#include <nlohmann/json.hpp>

namespace vs {
namespace {

using Json = nlohmann::json;

constexpr std::array<std::string_view, 3> kStates = {"completed", "aborted", "failed"};
constexpr std::array<std::string_view, 4> kClasses = {"undefined", "pass", "warn", "fail"};

template <size_t kCount>
size_t IndexOf(const std::array<std::string_view, kCount>& names, std::string_view name) {
  for (size_t i = 0; i < kCount; ++i) {
    if (names[i] == name) return i;
  }
  return 0;
}

}  // namespace

size_t SizeBytes(const StoredResult& result) {
  constexpr size_t kNumbers = 200;  // with the id, the times and the classes
  constexpr size_t kValue = 24;     // a number, or what goes around a text
  const ResultRecord& record = result.record;
  size_t bytes = kNumbers + record.job_id.size() + record.part_id.size() + record.meas_id.size() +
                 record.reason.size();
  for (const auto& [name, value] : record.values) {
    const auto* text = std::get_if<std::string>(&value);
    bytes += name.size() + kValue + (text == nullptr ? 0 : text->size());
  }
  return bytes;
}

std::string_view ResultStateName(ResultRecord::State state) {
  return kStates[static_cast<size_t>(state)];
}

ResultRecord::State ResultStateOf(std::string_view name) {
  return static_cast<ResultRecord::State>(IndexOf(kStates, name));
}

std::string_view ResultClassName(ResultRecord::Class result_class) {
  return kClasses[static_cast<size_t>(result_class)];
}

ResultRecord::Class ResultClassOf(std::string_view name) {
  return static_cast<ResultRecord::Class>(IndexOf(kClasses, name));
}

std::string ParameterHashText(uint64_t hash) {
  std::array<char, 17> text{};
  std::snprintf(text.data(), text.size(), "%016llx", static_cast<unsigned long long>(hash));
  return text.data();
}

std::string FieldsToJson(const std::map<std::string, ParamValue>& fields) {
  Json json = Json::object();
  for (const auto& [name, value] : fields) {
    std::visit([&json, &key = name](const auto& held) { json[key] = held; }, value);
  }
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

std::map<std::string, ParamValue> FieldsFromJson(std::string_view json) {
  std::map<std::string, ParamValue> fields;
  const Json parsed = Json::parse(json, nullptr, false);
  if (!parsed.is_object()) return fields;
  for (const auto& [name, value] : parsed.items()) {
    if (value.is_boolean()) {
      fields[name] = value.get<bool>();
    } else if (value.is_number_integer()) {
      fields[name] = value.get<int64_t>();
    } else if (value.is_number()) {
      fields[name] = value.get<double>();
    } else if (value.is_string()) {
      fields[name] = value.get<std::string>();
    }
  }
  return fields;
}

}  // namespace vs
