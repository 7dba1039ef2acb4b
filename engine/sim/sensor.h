#pragma once

#include <cstdint>

#include "engine/image/image.h"

namespace vs::sim {

// The settings of a simulated sensor; their units are those of the Basler camera it imitates.
struct SensorSettings {
  double exposure_us = 10'000;  // 16 .. 10,000,000; at 10,000 and gain 0 the scene looks right
  int gain_raw = 0;             // 0 .. 500, in steps of 0.0359 dB
  int black_level_raw = 0;      // 0 .. 1023, sixteenths of a grey level
  int binning_x = 1;            // 1 .. 4
  int binning_y = 1;
  // The part of the (binned) picture that is read out.
  int offset_x = 0;
  int offset_y = 0;
  int width = 0;
  int height = 0;

  bool operator==(const SensorSettings&) const = default;
};

inline constexpr int kMaxBinning = 4;
inline constexpr int kMaxGainRaw = 500;
inline constexpr int kMaxBlackLevelRaw = 1023;
inline constexpr double kMinExposureUs = 16;
inline constexpr double kMaxExposureUs = 10'000'000;
inline constexpr double kNominalExposureUs = 10'000;

// Light that falls on a pixel: 128 units make one grey level at nominal exposure and gain 0.
using Light = uint16_t;
inline constexpr int kLightPerGrey = 128;

// The factor by which a gain setting brightens the picture; 1 at 0, 7.9 at 500.
double GainFactor(int gain_raw);

// The noise of one camera.
struct SensorNoise {
  double amount = 1;  // 0 = none, 1 = as a real camera's (0.8 grey levels in the dark, 1.7 at 120)
  uint64_t seed = 1;
};

// Turns light into grey values:
//   grey = clamp(light * exposure * gain + black level + noise),
// with read noise and shot noise (EMVA 1288's linear model). The noise of a pixel depends on seed,
// instant and its place on the sensor only, so a window shows the same pixels as the whole picture.
class Sensor {
 public:
  Sensor(const SensorSettings& settings, double sensitivity, const SensorNoise& noise,
         int64_t instant_ns);

  // One row: `light` begins at column `x` of the (binned) sensor's row `y`.
  void ReadRow(const Light* light, int x, int y, int count, uint8_t* grey) const;

 private:
  float grey_per_light_;
  float black_grey_;
  float read_variance_;
  float variance_per_grey_;
  uint64_t noise_key_;
};

// Averages blocks of binning_x x binning_y pixels: the light of a binned pixel is the mean of its
// photosites', taken before noise is added. `rows` points to the first of binning_y rows.
void BinRow(const Light* rows, size_t row_pixels, int binning_x, int binning_y, int count,
            Light* binned);

}  // namespace vs::sim
