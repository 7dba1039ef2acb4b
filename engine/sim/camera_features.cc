#include "engine/sim/camera_features.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <map>
#include <utility>

#include "engine/base/str.h"

namespace vs::sim {
namespace {

using Type = FeatureInfo::Type;

constexpr double kMaxFrameRateHz = 1000;

std::optional<double> NumberIn(const FeatureValue& value) {
  if (const auto* integer = std::get_if<int64_t>(&value)) return static_cast<double>(*integer);
  if (const auto* real = std::get_if<double>(&value)) return *real;
  return std::nullopt;
}

Status CheckNumber(const FeatureInfo& info, const FeatureValue& value) {
  const std::optional<double> number = NumberIn(value);
  if (!number || (info.type == Type::kInteger && *number != std::floor(*number))) {
    return InvalidArgument(
        Str(info.name, " takes ", info.type == Type::kInteger ? "a whole number" : "a number"));
  }
  if (*number >= *info.min && *number <= *info.max) return {};
  return OutOfRange(Str(info.name, " must be from ", *info.min, " to ", *info.max,
                        info.unit.empty() ? "" : " ", info.unit, ", not ", *number));
}

Status CheckChoice(const FeatureInfo& info, const FeatureValue& value) {
  const auto* text = std::get_if<std::string>(&value);
  if (text != nullptr && std::count(info.choices.begin(), info.choices.end(), *text) == 1) {
    return {};
  }
  std::string choices;
  for (const std::string& choice : info.choices) choices += (choices.empty() ? "" : ", ") + choice;
  return InvalidArgument(Str(info.name, " takes one of ", choices));
}

}  // namespace

CameraFeatures::CameraFeatures(int sensor_width, int sensor_height, std::string serial_number)
    : sensor_width_(sensor_width),
      sensor_height_(sensor_height),
      serial_number_(std::move(serial_number)) {
  sensor_.width = sensor_width;
  sensor_.height = sensor_height;
}

CameraFeatures::Row CameraFeatures::Integer(const char* name, const char* unit,
                                            const char* description, int value, int min, int max,
                                            bool sets_size) {
  Row row;
  row.info = {name, Type::kInteger, unit, description, true, double(min), double(max), {}};
  row.value = int64_t{value};
  row.sets_size = sets_size;
  return row;
}

CameraFeatures::Row CameraFeatures::Choice(const char* name, const char* description,
                                           const char* value, std::vector<std::string> choices) {
  Row row;
  row.info = {name, Type::kEnumeration, "", description, true, {}, {}, std::move(choices)};
  row.value = std::string(value);
  return row;
}

std::vector<CameraFeatures::Row> CameraFeatures::Rows() const {
  const SensorSettings& s = sensor_;
  const int width_max = sensor_width_ / s.binning_x;
  const int height_max = sensor_height_ / s.binning_y;
  const auto real = [](const char* name, const char* unit, const char* description, double value,
                       double min, double max) {
    return Row{{name, Type::kFloat, unit, description, true, min, max, {}}, value};
  };
  const auto text = [](const char* name, const char* description, const std::string& value) {
    return Row{{name, Type::kString, "", description, false, {}, {}, {}}, value};
  };
  return {
      text("DeviceVendorName", "Name of the manufacturer of the device.", "VisionServer"),
      text("DeviceModelName", "Model of the device.", "simulated camera"),
      text("DeviceID", "Serial number of the device.", serial_number_),
      Integer("Width", "px", "Width of the picture.", s.width, 1, width_max - s.offset_x, true),
      Integer("Height", "px", "Height of the picture.", s.height, 1, height_max - s.offset_y, true),
      Integer("OffsetX", "px", "Column of the sensor where the picture begins.", s.offset_x, 0,
              width_max - s.width, true),
      Integer("OffsetY", "px", "Row of the sensor where the picture begins.", s.offset_y, 0,
              height_max - s.height, true),
      Integer("BinningHorizontal", "", "Number of neighbouring columns that are averaged into one.",
              s.binning_x, 1, kMaxBinning, true),
      Integer("BinningVertical", "", "Number of neighbouring rows that are averaged into one.",
              s.binning_y, 1, kMaxBinning, true),
      Integer("GainRaw", "", "Gain in steps of 0.0359 dB.", s.gain_raw, 0, kMaxGainRaw),
      Integer("BlackLevelRaw", "", "Black level in sixteenths of an 8-bit grey level.",
              s.black_level_raw, 0, kMaxBlackLevelRaw),
      real("ExposureTimeAbs", "us", "Exposure time.", s.exposure_us, kMinExposureUs,
           kMaxExposureUs),
      real("AcquisitionFrameRateAbs", "Hz", "Frame rate of a free-running camera.", frame_rate_hz_,
           0.1, kMaxFrameRateHz),
      Choice("TriggerMode", "Whether the camera waits for software triggers.",
             waits_for_trigger_ ? "On" : "Off", {"Off", "On"}),
      Choice("TriggerSource", "Where triggers come from.", "Software", {"Software"}),
      {{"TriggerSoftware",
        Type::kCommand,
        "",
        "Triggers the camera if it waits for a software trigger.",
        waits_for_trigger_,
        {},
        {},
        {}},
       true},
  };
}

Result<CameraFeatures::Row> CameraFeatures::Find(const std::string& name) const {
  std::string names;
  for (Row& row : Rows()) {
    if (row.info.name == name) return std::move(row);
    names += (names.empty() ? "" : ", ") + row.info.name;
  }
  return NotFound(Str("a simulated camera has no feature \"", name, "\"; it has ", names));
}

std::vector<FeatureInfo> CameraFeatures::List() const {
  std::vector<FeatureInfo> list;
  for (Row& row : Rows()) list.push_back(std::move(row.info));
  return list;
}

Result<FeatureValue> CameraFeatures::Get(const std::string& name) const {
  VS_ASSIGN_OR_RETURN(const Row row, Find(name));
  return row.value;
}

Result<FeatureValue> CameraFeatures::Set(const std::string& name, const FeatureValue& value,
                                         bool streaming) {
  VS_ASSIGN_OR_RETURN(const Row row, Find(name));
  if (!row.info.writable) return FailedPrecondition(name + " cannot be written now");
  if (row.sets_size && streaming) {
    return FailedPrecondition(name + " changes the size of the pictures: stop the camera first");
  }
  if (row.info.type == Type::kEnumeration) {
    VS_RETURN_IF_ERROR(CheckChoice(row.info, value));
    if (name == "TriggerMode") waits_for_trigger_ = std::get<std::string>(value) == "On";
  } else if (row.info.type != Type::kCommand) {
    VS_RETURN_IF_ERROR(CheckNumber(row.info, value));
    StoreNumber(name, *NumberIn(value));
  }
  return Get(name);
}

Result<FeatureValue> CameraFeatures::SetText(const std::string& name, const std::string& text) {
  VS_ASSIGN_OR_RETURN(const Row row, Find(name));
  if (row.info.type == Type::kEnumeration) return Set(name, text, false);
  char* end = nullptr;
  const double number = std::strtod(text.c_str(), &end);
  if (text.empty() || *end != '\0')
    return InvalidArgument(Str(name, " takes a number, not ", text));
  return Set(name, number, false);
}

void CameraFeatures::StoreNumber(const std::string& name, double value) {
  const auto whole = static_cast<int>(value);
  if (name == "BinningHorizontal") return SetBinning(whole, sensor_.binning_y);
  if (name == "BinningVertical") return SetBinning(sensor_.binning_x, whole);
  const std::map<std::string, int*> integers = {
      {"Width", &sensor_.width},      {"Height", &sensor_.height},
      {"OffsetX", &sensor_.offset_x}, {"OffsetY", &sensor_.offset_y},
      {"GainRaw", &sensor_.gain_raw}, {"BlackLevelRaw", &sensor_.black_level_raw}};
  if (const auto integer = integers.find(name); integer != integers.end()) {
    *integer->second = whole;
  } else if (name == "ExposureTimeAbs") {
    sensor_.exposure_us = value;
  } else if (name == "AcquisitionFrameRateAbs") {
    frame_rate_hz_ = value;
  }
}

// The window keeps its place on the sensor.
void CameraFeatures::SetBinning(int binning_x, int binning_y) {
  const auto rescale = [](int* size, int* offset, int old_binning, int binning, int sensor_size) {
    const int max = sensor_size / binning;
    *size = std::clamp(*size * old_binning / binning, 1, max);
    *offset = std::min(*offset * old_binning / binning, max - *size);
  };
  rescale(&sensor_.width, &sensor_.offset_x, sensor_.binning_x, binning_x, sensor_width_);
  rescale(&sensor_.height, &sensor_.offset_y, sensor_.binning_y, binning_y, sensor_height_);
  sensor_.binning_x = binning_x;
  sensor_.binning_y = binning_y;
}

}  // namespace vs::sim
