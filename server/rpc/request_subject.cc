#include "server/rpc/request_subject.h"

#include <google/protobuf/descriptor.h>
#include <google/protobuf/message.h>

#include <array>
#include <string_view>

#include "engine/base/str.h"

namespace vs {
namespace {

using google::protobuf::FieldDescriptor;
using google::protobuf::Message;

// Fields that say who or what is meant; the first that is there and not empty.
constexpr std::array<const char*, 5> kNames = {"sequence", "id", "name", "user", "session_id"};
// Repeated fields of what is set: texts, or messages with such a name.
constexpr std::array<const char*, 2> kParts = {"values", "paths"};
constexpr std::array<const char*, 2> kPartNames = {"path", "name"};
// What the caller says for the record.
constexpr std::array<const char*, 1> kReasons = {"reason"};

bool IsText(const FieldDescriptor* field) {
  return field != nullptr && field->cpp_type() == FieldDescriptor::CPPTYPE_STRING &&
         field->type() == FieldDescriptor::TYPE_STRING;
}

template <size_t count>
std::string FirstText(const Message& message, const std::array<const char*, count>& names) {
  for (const char* name : names) {
    const FieldDescriptor* field = message.GetDescriptor()->FindFieldByName(name);
    if (!IsText(field) || field->is_repeated()) continue;
    std::string text = message.GetReflection()->GetString(message, field);
    if (!text.empty()) return text;
  }
  return "";
}

void AddPart(const std::string& part, std::string* parts) {
  if (!part.empty()) *parts += (parts->empty() ? "" : ", ") + part;
}

void AddRepeated(const Message& message, const FieldDescriptor* field, std::string* parts) {
  const google::protobuf::Reflection& reflection = *message.GetReflection();
  for (int i = 0; i < reflection.FieldSize(message, field); ++i) {
    if (IsText(field)) {
      AddPart(reflection.GetRepeatedString(message, field, i), parts);
    } else if (field->cpp_type() == FieldDescriptor::CPPTYPE_MESSAGE) {
      AddPart(FirstText(reflection.GetRepeatedMessage(message, field, i), kPartNames), parts);
    }
  }
}

}  // namespace

std::optional<std::string> SubjectOf(const Message& request) {
  const google::protobuf::Descriptor& type = *request.GetDescriptor();
  const google::protobuf::Reflection& reflection = *request.GetReflection();
  const FieldDescriptor* check = type.FindFieldByName("validate_only");
  if (check != nullptr && reflection.GetBool(request, check)) return std::nullopt;

  std::string parts;
  for (const char* name : kParts) {
    const FieldDescriptor* field = type.FindFieldByName(name);
    if (field != nullptr && field->is_repeated()) AddRepeated(request, field, &parts);
  }
  // Of a change that names its fields by their presence.
  for (int i = 0; i < type.field_count(); ++i) {
    const FieldDescriptor* field = type.field(i);
    if (field->has_optional_keyword() && reflection.HasField(request, field)) {
      AddPart(field->name(), &parts);
    }
  }
  std::string subject = FirstText(request, kNames);
  if (!parts.empty()) subject += (subject.empty() ? "" : ": ") + parts;
  const std::string why = FirstText(request, kReasons);
  return why.empty() ? subject : Str(subject, " (", why, ")");
}

}  // namespace vs
