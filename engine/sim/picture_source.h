#pragma once

#include <cstdint>
#include <vector>

#include "engine/image/image.h"
#include "engine/sim/sensor.h"

namespace vs::sim {

// A simulated camera's sensor and what falls on it. For one thread at a time.
class PictureSource {
 public:
  // `sensitivity` is how much brighter this camera's pictures are than its twin's.
  PictureSource(int width, int height, double sensitivity, const SensorNoise& noise)
      : width_(width), height_(height), sensitivity_(sensitivity), noise_(noise) {}
  virtual ~PictureSource() = default;

  // Of the whole sensor, in pixels.
  int width() const { return width_; }
  int height() const { return height_; }
  // The whole sensor at nominal exposure.
  SensorSettings DefaultSettings() const;

  // Takes the picture of `instant_ns` into `picture`, which has the size of the settings' window
  // and of which every pixel is written. The same for the same arguments on every CPU.
  void Capture(int64_t instant_ns, const SensorSettings& settings, GreyImage& picture);

 protected:
  // Prepares the light of an instant ...
  virtual void Look(int64_t instant_ns) = 0;
  // ... of which this hands out `count` whole rows, from row `y` on. Valid until the next call.
  virtual const Light* LightRows(int y, int count) = 0;

 private:
  int width_;
  int height_;
  double sensitivity_;
  SensorNoise noise_;
  std::vector<Light> binned_;  // one row
};

}  // namespace vs::sim
