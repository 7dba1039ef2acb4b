#include "client/cli/words.h"

#include <google/protobuf/util/time_util.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <ctime>
#include <string_view>

namespace vs::cli {

namespace v1 = ::visionserver::v1;

namespace {

using client::Code;
using client::Failure;
using client::Result;

// "CAMERA_STATE_IDLE" without "CAMERA_STATE_", in small letters with blanks.
std::string Word(std::string name, std::string_view prefix) {
  if (!name.starts_with(prefix)) return "unknown";
  name.erase(0, prefix.size());
  for (char& c : name) {
    c = c == '_' ? ' ' : static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  }
  return name;
}

std::string EnumName(std::string_view prefix, const std::string& word) {
  std::string name(prefix);
  for (const char c : word) name += static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  return name;
}

}  // namespace

std::string RoleWord(v1::Role role) { return Word(v1::Role_Name(role), "ROLE_"); }

std::string CameraStateWord(v1::CameraState state) {
  return Word(v1::CameraState_Name(state), "CAMERA_STATE_");
}

std::string FeatureTypeWord(v1::FeatureType type) {
  return Word(v1::FeatureType_Name(type), "FEATURE_TYPE_");
}

std::string RunStateWord(v1::SequenceRunState state) {
  return Word(v1::SequenceRunState_Name(state), "SEQUENCE_RUN_STATE_");
}

std::string StreamKindWord(v1::StreamKind kind) {
  return Word(v1::StreamKind_Name(kind), "STREAM_KIND_");
}

std::string ResultClassWord(v1::ResultClass result_class) {
  if (result_class == v1::RESULT_CLASS_UNSPECIFIED) return "-";
  return Word(v1::ResultClass_Name(result_class), "RESULT_CLASS_");
}

Result<v1::Role> ParseRole(const std::string& word) {
  v1::Role role = v1::ROLE_UNSPECIFIED;
  if (v1::Role_Parse(EnumName("ROLE_", word), &role) && role != v1::ROLE_UNSPECIFIED) return role;
  return Failure(Code::kInvalidArgument,
                 "\"" + word + "\" is no role; there are viewer, operator, engineer, admin, robot");
}

Result<v1::ResultClass> ParseResultClass(const std::string& word) {
  v1::ResultClass result_class = v1::RESULT_CLASS_UNSPECIFIED;
  if (word.empty() || v1::ResultClass_Parse(EnumName("RESULT_CLASS_", word), &result_class)) {
    return result_class;
  }
  return Failure(Code::kInvalidArgument,
                 "\"" + word + "\" is no class of results; there are pass, warn, fail");
}

Result<google::protobuf::Timestamp> ParseTime(const std::string& text) {
  google::protobuf::Timestamp time;
  if (google::protobuf::util::TimeUtil::FromString(text, &time)) return time;
  for (const char* format : {"%Y-%m-%d %H:%M:%S", "%Y-%m-%d %H:%M", "%Y-%m-%d"}) {
    std::tm local{};
    local.tm_isdst = -1;
    const char* end = ::strptime(text.c_str(), format, &local);
    if (end == nullptr || *end != '\0') continue;
    time.set_seconds(std::mktime(&local));
    return time;
  }
  return Failure(Code::kInvalidArgument,
                 "\"" + text +
                     "\" is no time; write 2026-01-31T14:03:00Z, or 2026-01-31 14:03:00 "
                     "in local time, or 2026-01-31");
}

}  // namespace vs::cli
