#pragma once

#include <map>
#include <string>
#include <vector>

#include "engine/camera/camera_source.h"

namespace vs {

// The features that were set on a camera, so that they can be set again after a reconnect, in the
// same order. A feature that depends on selectors (TriggerMode on TriggerSelector) is remembered
// once for each state of the selectors, and they are set again before it. Bounded: setting the same
// features over and over does not grow it.
class FeatureMemory {
 public:
  struct Setting {
    std::string name;
    FeatureValue value;
  };

  void Remember(const std::string& name, const FeatureValue& value);
  // What to set, in order.
  std::vector<Setting> Replay() const;

 private:
  using Selectors = std::map<std::string, FeatureValue>;
  struct Entry {
    Selectors selectors;  // as they were when the feature was set
    Setting setting;
  };

  Selectors selectors_;
  std::vector<Entry> entries_;
};

}  // namespace vs
