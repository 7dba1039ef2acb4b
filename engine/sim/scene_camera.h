#pragma once

#include <memory>

#include "engine/image/stereo_rig.h"
#include "engine/sim/picture_source.h"
#include "engine/sim/view.h"

namespace vs::sim {

// One camera of a rig that looks at the demo scene. What stands still is ray-cast once, which takes
// about a second for a megapixel; each picture then costs a few milliseconds.
class SceneCamera final : public PictureSource {
 public:
  struct Settings {
    StereoRig rig;
    Side side = Side::kLeft;
    double sensitivity = 1;
    SensorNoise noise;  // left and right draw different noise from the same seed
  };
  explicit SceneCamera(const Settings& settings);
  ~SceneCamera() override;

 protected:
  void Look(int64_t instant_ns) override;
  const Light* LightRows(int y, int count) override;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace vs::sim
