#pragma once

#include <arv.h>

#include <string>
#include <vector>

#include "engine/base/status.h"
#include "engine/camera/camera_source.h"

namespace vs {

// The GenICam features of an open camera. Each call talks to the camera and may wait for it: for
// its device thread only. Errors: NOT_FOUND (no such feature, with the nearest names),
// INVALID_ARGUMENT, OUT_OF_RANGE (with range and unit), FAILED_PRECONDITION (read-only or locked
// now), UNAVAILABLE (no answer).
class GevFeatures {
 public:
  explicit GevFeatures(ArvDevice* device) : device_(device) {}

  // All features that this camera implements, in the order of its own description.
  std::vector<std::string> Names() const;
  bool Has(const std::string& name) const;
  // It cannot be written now, but can be while the camera does not stream.
  bool Locked(const std::string& name) const;
  Result<FeatureInfo> Info(const std::string& name) const;
  Result<FeatureValue> Get(const std::string& name) const;
  // The value that the camera reads back.
  Result<FeatureValue> Set(const std::string& name, const FeatureValue& value) const;
  // The same, from text as it stands in a URI.
  Result<FeatureValue> SetText(const std::string& name, const std::string& text) const;

 private:
  Result<FeatureInfo> Writable(const std::string& name) const;

  ArvDevice* device_;
};

}  // namespace vs
