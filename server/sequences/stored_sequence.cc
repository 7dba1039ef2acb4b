#include "server/sequences/stored_sequence.h"

#include <array>
#include <cstdio>
#include <utility>

#include <nlohmann/json.hpp>

#include "engine/base/str.h"

namespace vs {
namespace {

using Json = nlohmann::json;

// Takes `key` out of `json`; leaves `target` alone when it is not there.
template <class T>
Status Take(Json& json, const char* key, bool (Json::*is_type)() const, const char* type_name,
            T* target) {
  const auto found = json.find(key);
  if (found == json.end()) return Status();
  if (!((*found).*is_type)()) return InvalidArgument(Str(key, " must be ", type_name));
  *target = found->get<T>();
  json.erase(found);
  return Status();
}

}  // namespace

std::string FormatSequenceFile(const StoredSequence& stored) {
  const Json json = {
      {"autostart", stored.autostart},   {"created_ns", stored.created_ns},
      {"revision", stored.revision},     {"sequence", Json::parse(ToJson(stored.spec))},
      {"updated_by", stored.updated_by}, {"updated_ns", stored.updated_ns}};
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

Result<StoredSequence> ParseSequenceFile(std::string_view text) {
  StoredSequence stored;
  Json json = Json::parse(text, nullptr, false);
  if (!json.is_object() || !json.contains("sequence")) {
    // Also says where the JSON is malformed.
    VS_ASSIGN_OR_RETURN(stored.spec, ParseSequence(text));
    stored.etag = EtagOf(stored);
    return stored;
  }
  VS_ASSIGN_OR_RETURN(stored.spec, ParseSequence(json["sequence"].dump()));
  json.erase("sequence");
  VS_RETURN_IF_ERROR(
      Take(json, "autostart", &Json::is_boolean, "true or false", &stored.autostart));
  VS_RETURN_IF_ERROR(
      Take(json, "created_ns", &Json::is_number_integer, "an integer", &stored.created_ns));
  VS_RETURN_IF_ERROR(
      Take(json, "updated_ns", &Json::is_number_integer, "an integer", &stored.updated_ns));
  VS_RETURN_IF_ERROR(Take(json, "updated_by", &Json::is_string, "a text", &stored.updated_by));
  VS_RETURN_IF_ERROR(
      Take(json, "revision", &Json::is_number_unsigned, "a positive integer", &stored.revision));
  if (!json.empty()) return InvalidArgument(Str("unknown key \"", json.begin().key(), "\""));
  if (stored.revision == 0) return InvalidArgument("revision must be at least 1");
  stored.etag = EtagOf(stored);
  return stored;
}

std::string EtagOf(const StoredSequence& stored) {
  uint64_t hash = 0xcbf29ce484222325;  // FNV-1a
  for (const char c : FormatSequenceFile(stored)) {
    hash = (hash ^ static_cast<uint8_t>(c)) * 0x100000001b3;
  }
  std::array<char, 17> digits{};
  std::snprintf(digits.data(), digits.size(), "%016llx", static_cast<unsigned long long>(hash));
  return Str(stored.revision, '-', digits.data());
}

}  // namespace vs
