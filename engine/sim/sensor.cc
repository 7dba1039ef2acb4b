#include "engine/sim/sensor.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "engine/sim/hash.h"
#include "engine/sim/simd.h"

namespace vs::sim {
namespace {

// Of a camera at gain 0: in the dark, and per grey level of signal.
constexpr double kReadNoiseGrey = 0.8;
constexpr double kShotVariancePerGrey = 0.018;

// Noise is drawn in runs, each from a random place of one table of normal deviates.
constexpr int kRunPixels = 512;
constexpr int kDeviates = 1 << 16;
constexpr float kDeviateScale = 1.0f / 4096;

// The sum of eight random bytes is close enough to a normal deviate (Irwin and Hall).
std::vector<int16_t> MakeDeviates() {
  constexpr double kSigmaOfSum = 209.0;  // sqrt(8 * (256^2 - 1) / 12)
  std::vector<int16_t> deviates(kDeviates + kRunPixels);
  for (int i = 0; i < kDeviates; ++i) {
    uint64_t bits = Hash(static_cast<uint64_t>(i));
    int sum = 0;
    for (int byte = 0; byte < 8; ++byte, bits >>= 8) sum += static_cast<int>(bits & 255);
    deviates[i] = static_cast<int16_t>((sum - 1020) / (kSigmaOfSum * kDeviateScale));
  }
  std::copy_n(deviates.begin(), kRunPixels, deviates.begin() + kDeviates);
  return deviates;
}

struct Response {
  float grey_per_light, black, read_variance, variance_per_grey;
};

VS_SIM_CLONES
void Respond(const Response& r, const Light* __restrict light, const int16_t* __restrict deviate,
             int count, uint8_t* __restrict grey) {
  for (int i = 0; i < count; ++i) {
    const float signal = static_cast<float>(light[i]) * r.grey_per_light;
    const float sigma = std::sqrt(r.read_variance + r.variance_per_grey * signal);
    const float value =
        signal + r.black + sigma * (static_cast<float>(deviate[i]) * kDeviateScale) + 0.5f;
    const float floored = value > 0.0f ? value : 0.0f;
    grey[i] = static_cast<uint8_t>(static_cast<int>(floored < 255.0f ? floored : 255.0f));
  }
}

template <int kX, int kY>
void BinFixed(const Light* __restrict rows, size_t row_pixels, int count,
              Light* __restrict binned) {
  for (int i = 0; i < count; ++i) {
    uint32_t sum = kX * kY / 2;
    for (int y = 0; y < kY; ++y) {
      for (int x = 0; x < kX; ++x) sum += rows[y * row_pixels + static_cast<size_t>(i) * kX + x];
    }
    binned[i] = static_cast<Light>(sum / (kX * kY));
  }
}

}  // namespace

double GainFactor(int gain_raw) {
  // 10^(0.0359 / 20) by squaring: std::pow differs in the last bit from one CPU to another.
  double factor = 1;
  double power = 1.004141693445858;
  for (int bits = gain_raw; bits > 0; bits >>= 1, power *= power) {
    if ((bits & 1) != 0) factor *= power;
  }
  return factor;
}

Sensor::Sensor(const SensorSettings& settings, double sensitivity, const SensorNoise& noise,
               int64_t instant_ns) {
  const double gain = GainFactor(settings.gain_raw);
  grey_per_light_ = static_cast<float>(settings.exposure_us / kNominalExposureUs * gain *
                                       sensitivity / kLightPerGrey);
  black_grey_ = static_cast<float>(settings.black_level_raw / 16.0);
  const double read_noise = kReadNoiseGrey * gain * noise.amount;
  read_variance_ = static_cast<float>(read_noise * read_noise);
  variance_per_grey_ =
      static_cast<float>(kShotVariancePerGrey * gain * noise.amount * noise.amount);
  noise_key_ = Hash(noise.seed ^ Hash(static_cast<uint64_t>(instant_ns)));
}

void Sensor::ReadRow(const Light* light, int x, int y, int count, uint8_t* grey) const {
  static const std::vector<int16_t> deviates = MakeDeviates();
  const Response response = {grey_per_light_, black_grey_, read_variance_, variance_per_grey_};
  for (int begin = x; begin < x + count;) {
    const int run = begin / kRunPixels;
    const int end = std::min(x + count, (run + 1) * kRunPixels);
    const uint64_t place = Hash(noise_key_ + (static_cast<uint64_t>(y) << 16) + run);
    const int16_t* deviate =
        &deviates[(place & (kDeviates - 1)) + static_cast<size_t>(begin % kRunPixels)];
    Respond(response, light + (begin - x), deviate, end - begin, grey + (begin - x));
    begin = end;
  }
}

VS_SIM_CLONES
void BinRow(const Light* rows, size_t row_pixels, int binning_x, int binning_y, int count,
            Light* binned) {
  if (binning_x == 2 && binning_y == 2) return BinFixed<2, 2>(rows, row_pixels, count, binned);
  const auto area = static_cast<uint32_t>(binning_x * binning_y);
  for (int i = 0; i < count; ++i) {
    uint32_t sum = area / 2;
    for (int y = 0; y < binning_y; ++y) {
      for (int x = 0; x < binning_x; ++x)
        sum += rows[y * row_pixels + static_cast<size_t>(i) * binning_x + x];
    }
    binned[i] = static_cast<Light>(sum / area);
  }
}

}  // namespace vs::sim
