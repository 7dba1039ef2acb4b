#pragma once

#include <memory>
#include <optional>
#include <string>

#include "engine/base/status.h"
#include "engine/calibration/rectifier.h"
#include "engine/core/environment.h"
#include "engine/core/param.h"

namespace vs {

// The parameters of a block that rectifies, and the rectifier that follows from them.
class RectifyParams {
 public:
  explicit RectifyParams(Block* owner) : owner_(owner) {}

  // Finds the rig; for Block::Start(). Errors say which calibration is missing.
  Status Start(const Environment& environment);
  // For raw pictures of this size, after Start(); the same until parameters or size change. Errors
  // as Rectifier::Make.
  Result<const Rectifier*> For(int width, int height);
  // The cameras, after Start().
  const StereoRig& rig() const { return *found_rig_; }

 private:
  Result<std::shared_ptr<const StereoRig>> FindRig(const Environment& environment) const;
  RectifyOptions Options() const;

  Block* owner_;

  Param<std::string> rig_{
      owner_,
      "rig",
      {.live = false,
       .doc =
           "Name of the stored calibration of these two cameras. Leave it empty to use a file."}};
  Param<std::string> rig_file_{
      owner_,
      "rig_file",
      {.live = false,
       .doc = "Calibration file below the server's data folder, used when no stored calibration "
              "is named."}};
  Param<double> alpha_{
      owner_,
      "alpha",
      {.initial = 0,
       .min = 0.0,
       .max = 1.0,
       .doc = "How much to show: 0 only what lies inside both pictures, 1 everything, with "
              "black borders."}};
  Param<std::string> interpolation_{
      owner_,
      "interpolation",
      {.initial = "linear",
       .choices = {"nearest", "linear", "cubic"},
       .doc = "How a grey value between pixels is found; cubic is sharper and slower."}};
  Param<std::string> precision_{
      owner_,
      "precision",
      {.initial = "fixed",
       .choices = {"fixed", "float"},
       .doc = "How exactly the place of each pixel is known: fixed is 1/32 px and quicker; float "
              "takes a faint ripple out of depth."}};
  Param<std::string> resolution_{
      owner_,
      "resolution",
      {.initial = "full",
       .choices = {"full", "half"},
       .doc = "With half the pictures are binned first, each pixel the mean of four: four times as "
              "quick to match, half as fine."}};

  std::shared_ptr<const StereoRig> found_rig_;
  std::optional<Rectifier> rectifier_;
  RectifyOptions options_;  // of rectifier_
};

}  // namespace vs
