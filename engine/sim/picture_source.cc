#include "engine/sim/picture_source.h"

namespace vs::sim {

SensorSettings PictureSource::DefaultSettings() const {
  return {.width = width_, .height = height_};
}

void PictureSource::Capture(int64_t instant_ns, const SensorSettings& settings,
                            GreyImage& picture) {
  VS_CHECK(picture.width() == settings.width && picture.height() == settings.height);
  VS_CHECK(settings.offset_x + settings.width <= width_ / settings.binning_x);
  VS_CHECK(settings.offset_y + settings.height <= height_ / settings.binning_y);
  const bool binned = settings.binning_x * settings.binning_y > 1;
  binned_.resize(settings.width);
  Look(instant_ns);
  const Sensor sensor(settings, sensitivity_, noise_, instant_ns);
  for (int y = 0; y < settings.height; ++y) {
    const int sensor_y = settings.offset_y + y;
    const Light* light = LightRows(sensor_y * settings.binning_y, settings.binning_y) +
                         static_cast<ptrdiff_t>(settings.offset_x) * settings.binning_x;
    if (binned) {
      BinRow(light, width_, settings.binning_x, settings.binning_y, settings.width, binned_.data());
      light = binned_.data();
    }
    sensor.ReadRow(light, settings.offset_x, sensor_y, settings.width, picture.Row(y));
  }
}

}  // namespace vs::sim
