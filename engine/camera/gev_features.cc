#include "engine/camera/gev_features.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cstdio>
#include <limits>
#include <memory>
#include <optional>
#include <set>

#include "engine/base/str.h"
#include "engine/camera/gev_glib.h"

namespace vs {
namespace {

using Type = FeatureInfo::Type;

ArvGcFeatureNode* Find(ArvDevice* device, const std::string& name) {
  ArvGcNode* node = arv_device_get_feature(device, name.c_str());
  return ARV_IS_GC_FEATURE_NODE(node) ? ARV_GC_FEATURE_NODE(node) : nullptr;
}

std::optional<Type> TypeOf(ArvGcFeatureNode* node) {
  if (ARV_IS_GC_COMMAND(node)) return Type::kCommand;
  if (ARV_IS_GC_BOOLEAN(node)) return Type::kBoolean;
  if (ARV_IS_GC_ENUMERATION(node)) return Type::kEnumeration;
  if (ARV_IS_GC_FLOAT(node)) return Type::kFloat;
  if (ARV_IS_GC_INTEGER(node)) return Type::kInteger;
  if (ARV_IS_GC_STRING(node)) return Type::kString;
  return std::nullopt;
}

std::string_view TypeName(Type type) {
  switch (type) {
    case Type::kBoolean:
      return "true or false";
    case Type::kInteger:
      return "a whole number";
    case Type::kFloat:
      return "a number";
    case Type::kString:
      return "text";
    case Type::kEnumeration:
      return "one of its choices";
    case Type::kCommand:
      break;
  }
  return "true (it is a command)";
}

std::string TextOf(const char* text) { return text == nullptr ? "" : text; }

void Collect(ArvGc* genicam, const char* name, std::set<std::string>& seen,
             std::vector<std::string>& names) {
  ArvGcNode* node = arv_gc_get_node(genicam, name);
  if (!ARV_IS_GC_FEATURE_NODE(node) || !seen.insert(name).second) return;
  if (ARV_IS_GC_CATEGORY(node)) {
    for (const GSList* i = arv_gc_category_get_features(ARV_GC_CATEGORY(node)); i != nullptr;
         i = i->next) {
      Collect(genicam, static_cast<const char*>(i->data), seen, names);
    }
  } else if (TypeOf(ARV_GC_FEATURE_NODE(node)) &&
             arv_gc_feature_node_is_implemented(ARV_GC_FEATURE_NODE(node), nullptr)) {
    names.emplace_back(name);
  }
}

// "A, B" of those names that contain the wanted one, or of which it contains one.
std::string Nearest(const std::vector<std::string>& names, const std::string& wanted) {
  std::string nearest;
  for (const std::string& name : names) {
    if (name.find(wanted) == std::string::npos && wanted.find(name) == std::string::npos &&
        name.compare(0, 5, wanted, 0, 5) != 0) {
      continue;
    }
    nearest += (nearest.empty() ? "" : ", ") + name;
  }
  return nearest;
}

template <class Number, class Bound>
void SetBounds(Number min, Number max, Bound& info) {
  if (min > std::numeric_limits<Number>::lowest()) info.min = static_cast<double>(min);
  if (max < std::numeric_limits<Number>::max()) info.max = static_cast<double>(max);
}

void DescribeRange(ArvDevice* device, FeatureInfo& info) {
  GlibError error;
  const char* name = info.name.c_str();
  if (info.type == Type::kInteger) {
    int64_t min = 0;
    int64_t max = 0;
    arv_device_get_integer_feature_bounds(device, name, &min, &max, error.out());
    if (!error) SetBounds(min, max, info);
  } else if (info.type == Type::kFloat) {
    double min = 0;
    double max = 0;
    arv_device_get_float_feature_bounds(device, name, &min, &max, error.out());
    if (!error) SetBounds(min, max, info);
  } else if (info.type == Type::kEnumeration) {
    guint count = 0;
    const std::unique_ptr<const char*, void (*)(void*)> values(
        arv_device_dup_available_enumeration_feature_values_as_strings(device, name, &count,
                                                                       error.out()),
        g_free);
    for (guint i = 0; values != nullptr && i < count; ++i) {
      info.choices.emplace_back(values.get()[i]);
    }
  }
}

// Without an exponent where it can be avoided.
std::string NumberText(double value) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.15g", value);
  return text.data();
}

std::string RangeText(const FeatureInfo& info) {
  std::string text;
  if (info.type == Type::kEnumeration) {
    for (const std::string& choice : info.choices) text += (text.empty() ? "" : ", ") + choice;
    return "one of " + text;
  }
  text = TypeName(info.type);
  if (info.min) text += " from " + NumberText(*info.min);
  if (info.max) text += " up to " + NumberText(*info.max);
  return info.unit.empty() ? text : text + " " + info.unit;
}

Status WrongValue(const FeatureInfo& info, const FeatureValue& value) {
  const std::string text = std::visit([](const auto& plain) { return Str(plain); }, value);
  return InvalidArgument(Str("\"", text, "\" is not ", RangeText(info)));
}

Status CheckRange(const FeatureInfo& info, double value) {
  if ((!info.min || value >= *info.min) && (!info.max || value <= *info.max)) return {};
  return OutOfRange(Str(NumberText(value), " is not ", RangeText(info)));
}

std::optional<double> AsNumber(const FeatureValue& value) {
  if (const auto* integer = std::get_if<int64_t>(&value)) return static_cast<double>(*integer);
  if (const auto* number = std::get_if<double>(&value)) return *number;
  return std::nullopt;
}

Status WriteInteger(ArvDevice* device, const FeatureInfo& info, int64_t value) {
  VS_RETURN_IF_ERROR(CheckRange(info, static_cast<double>(value)));
  GlibError error;
  const char* name = info.name.c_str();
  const int64_t step = arv_device_get_integer_feature_increment(device, name, error.out());
  const auto base = static_cast<int64_t>(info.min.value_or(0));
  if (!error && step > 1 && (value - base) % step != 0) {
    return InvalidArgument(Str(value, " is not in steps of ", step, " from ", base));
  }
  arv_device_set_integer_feature_value(device, name, value, error.out());
  return error.ToStatus();
}

Status WriteEnumeration(ArvDevice* device, const FeatureInfo& info, const std::string& value) {
  if (std::ranges::count(info.choices, value) == 0) return WrongValue(info, value);
  GlibError error;
  arv_device_set_string_feature_value(device, info.name.c_str(), value.c_str(), error.out());
  return error.ToStatus();
}

// Writes a value of the right type.
Status Write(ArvDevice* device, const FeatureInfo& info, const FeatureValue& value) {
  GlibError error;
  const char* name = info.name.c_str();
  const auto* flag = std::get_if<bool>(&value);
  const auto* text = std::get_if<std::string>(&value);
  const auto number = AsNumber(value);
  switch (info.type) {
    case Type::kBoolean:
      if (flag == nullptr) return WrongValue(info, value);
      arv_device_set_boolean_feature_value(device, name, *flag ? TRUE : FALSE, error.out());
      return error.ToStatus();
    case Type::kInteger:
      if (!std::holds_alternative<int64_t>(value)) return WrongValue(info, value);
      return WriteInteger(device, info, std::get<int64_t>(value));
    case Type::kFloat:
      if (!number) return WrongValue(info, value);
      VS_RETURN_IF_ERROR(CheckRange(info, *number));
      arv_device_set_float_feature_value(device, name, *number, error.out());
      return error.ToStatus();
    case Type::kEnumeration:
      return text == nullptr ? WrongValue(info, value) : WriteEnumeration(device, info, *text);
    case Type::kString:
      if (text == nullptr) return WrongValue(info, value);
      arv_device_set_string_feature_value(device, name, text->c_str(), error.out());
      return error.ToStatus();
    case Type::kCommand:
      break;
  }
  if (flag == nullptr || !*flag) return WrongValue(info, value);
  arv_device_execute_command(device, name, error.out());
  return error.ToStatus();
}

// The value that `text` means for this feature; the text itself when it means none.
FeatureValue ValueFromText(Type type, const std::string& text) {
  const char* end = text.data() + text.size();
  if (type == Type::kBoolean || type == Type::kCommand) {
    if (text == "true" || text == "1") return true;
    if (text == "false" || text == "0") return false;
  } else if (type == Type::kInteger) {
    int64_t value = 0;
    if (std::from_chars(text.data(), end, value).ptr == end && !text.empty()) return value;
  } else if (type == Type::kFloat) {
    double value = 0;
    if (std::from_chars(text.data(), end, value).ptr == end && !text.empty()) return value;
  }
  return text;
}

}  // namespace

Status GlibError::ToStatus() const {
  if (error_ == nullptr) return {};
  std::string message = TextOf(error_->message);
  if (error_->domain == ARV_DEVICE_ERROR) {
    switch (error_->code) {
      case ARV_DEVICE_ERROR_TIMEOUT:
      case ARV_DEVICE_ERROR_NOT_CONNECTED:
      case ARV_DEVICE_ERROR_TRANSFER_ERROR:
        return Unavailable("the camera does not answer: " + message);
      case ARV_DEVICE_ERROR_NOT_CONTROLLER:
      case ARV_DEVICE_ERROR_PROTOCOL_ERROR_ACCESS_DENIED:
      case ARV_DEVICE_ERROR_PROTOCOL_ERROR_WRITE_PROTECT:
      case ARV_DEVICE_ERROR_PROTOCOL_ERROR_BUSY:
        return FailedPrecondition("the camera refuses: " + message);
      default:
        break;
    }
  }
  return InvalidArgument("the camera says: " + message);
}

std::vector<std::string> GevFeatures::Names() const {
  std::vector<std::string> names;
  std::set<std::string> seen;
  Collect(arv_device_get_genicam(device_), "Root", seen, names);
  return names;
}

bool GevFeatures::Has(const std::string& name) const {
  ArvGcFeatureNode* node = Find(device_, name);
  return node != nullptr && arv_gc_feature_node_is_implemented(node, nullptr) &&
         arv_gc_feature_node_is_available(node, nullptr);
}

bool GevFeatures::Locked(const std::string& name) const {
  ArvGcFeatureNode* node = Find(device_, name);
  return node != nullptr && arv_gc_feature_node_is_locked(node, nullptr);
}

Result<FeatureInfo> GevFeatures::Info(const std::string& name) const {
  ArvGcFeatureNode* node = Find(device_, name);
  const auto type = node == nullptr ? std::nullopt : TypeOf(node);
  if (!type || !arv_gc_feature_node_is_implemented(node, nullptr)) {
    const std::string nearest = Nearest(Names(), name);
    return NotFound(Str("this camera has no feature \"", name, "\"",
                        nearest.empty() ? "" : "; did you mean " + nearest));
  }
  FeatureInfo info;
  info.name = name;
  info.type = *type;
  info.description = TextOf(arv_gc_feature_node_get_tooltip(node));
  if (info.description.empty())
    info.description = TextOf(arv_gc_feature_node_get_description(node));
  if (ARV_IS_GC_FLOAT(node)) info.unit = TextOf(arv_gc_float_get_unit(ARV_GC_FLOAT(node)));
  if (*type == Type::kInteger) {
    info.unit = TextOf(arv_gc_integer_get_unit(ARV_GC_INTEGER(node)));
  }
  const bool available = arv_gc_feature_node_is_available(node, nullptr) != FALSE;
  info.writable = available && arv_gc_feature_node_is_locked(node, nullptr) == FALSE &&
                  arv_gc_feature_node_get_actual_access_mode(node) != ARV_GC_ACCESS_MODE_RO;
  if (available) DescribeRange(device_, info);
  return info;
}

Result<FeatureValue> GevFeatures::Get(const std::string& name) const {
  VS_ASSIGN_OR_RETURN(const FeatureInfo info, Info(name));
  GlibError error;
  FeatureValue value;
  switch (info.type) {
    case Type::kBoolean:
      value = arv_device_get_boolean_feature_value(device_, name.c_str(), error.out()) != FALSE;
      break;
    case Type::kInteger:
      value = int64_t{arv_device_get_integer_feature_value(device_, name.c_str(), error.out())};
      break;
    case Type::kFloat:
      value = arv_device_get_float_feature_value(device_, name.c_str(), error.out());
      break;
    case Type::kString:
    case Type::kEnumeration:
      value = TextOf(arv_device_get_string_feature_value(device_, name.c_str(), error.out()));
      break;
    case Type::kCommand:
      value = true;
      break;
  }
  if (error) return error.ToStatus().Annotated("feature " + name);
  return value;
}

Result<FeatureInfo> GevFeatures::Writable(const std::string& name) const {
  VS_ASSIGN_OR_RETURN(FeatureInfo info, Info(name));
  if (info.writable) return info;
  if (Locked(name)) {
    return FailedPrecondition(
        Str("feature ", name, " is locked by the camera at the moment, as it is while it streams"));
  }
  return FailedPrecondition(Str("feature ", name, " cannot be written at the moment"));
}

Result<FeatureValue> GevFeatures::Set(const std::string& name, const FeatureValue& value) const {
  VS_ASSIGN_OR_RETURN(const FeatureInfo info, Writable(name));
  if (Status status = Write(device_, info, value); !status.ok()) {
    return status.Annotated("feature " + name);
  }
  return Get(name);
}

Result<FeatureValue> GevFeatures::SetText(const std::string& name, const std::string& text) const {
  VS_ASSIGN_OR_RETURN(const FeatureInfo info, Info(name));
  return Set(name, ValueFromText(info.type, text));
}

}  // namespace vs
