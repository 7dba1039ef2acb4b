#pragma once

#include <string>
#include <vector>

#include "engine/base/status.h"
#include "engine/camera/camera_source.h"
#include "engine/sim/sensor.h"

namespace vs::sim {

// The settings of a simulated camera inside this process, under the names that the camera it
// imitates (and gevsim) gives them. Plain values; the owner locks.
class CameraFeatures {
 public:
  CameraFeatures(int sensor_width, int sensor_height, std::string serial_number);

  std::vector<FeatureInfo> List() const;
  Result<FeatureValue> Get(const std::string& name) const;
  // The value as it was stored. Errors: NOT_FOUND (no such feature), INVALID_ARGUMENT (a value of
  // another type), OUT_OF_RANGE (with range and unit), FAILED_PRECONDITION (read-only, or a change
  // of the picture's size while `streaming`).
  Result<FeatureValue> Set(const std::string& name, const FeatureValue& value, bool streaming);
  // The same, from text as it stands in a URI, before the camera streams.
  Result<FeatureValue> SetText(const std::string& name, const std::string& text);

  const SensorSettings& sensor() const { return sensor_; }
  double frame_rate_hz() const { return frame_rate_hz_; }
  bool waits_for_trigger() const { return waits_for_trigger_; }

 private:
  // One feature as it is now.
  struct Row {
    FeatureInfo info;
    FeatureValue value;
    bool sets_size = false;
  };
  static Row Integer(const char* name, const char* unit, const char* description, int value,
                     int min, int max, bool sets_size = false);
  static Row Choice(const char* name, const char* description, const char* value,
                    std::vector<std::string> choices);

  std::vector<Row> Rows() const;
  Result<Row> Find(const std::string& name) const;
  void StoreNumber(const std::string& name, double value);
  void SetBinning(int binning_x, int binning_y);

  int sensor_width_;
  int sensor_height_;
  std::string serial_number_;
  SensorSettings sensor_;
  double frame_rate_hz_ = 30;
  bool waits_for_trigger_ = false;
};

}  // namespace vs::sim
