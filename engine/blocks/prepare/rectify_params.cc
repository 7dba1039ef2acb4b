#include "engine/blocks/prepare/rectify_params.h"

#include <filesystem>
#include <utility>

#include "engine/calibration/rig_file.h"

namespace vs {

Status RectifyParams::Start(const Environment& environment) {
  rectifier_.reset();
  VS_ASSIGN_OR_RETURN(found_rig_, FindRig(environment));
  return {};
}

// The maps depend on the size of the pictures, which only the first pair tells.
Result<const Rectifier*> RectifyParams::For(int width, int height) {
  const RectifyOptions options = Options();
  if (!rectifier_ || !rectifier_->Fits(width, height) || options != options_) {
    VS_ASSIGN_OR_RETURN(rectifier_, Rectifier::Make(*found_rig_, width, height, options));
    options_ = options;
  }
  return &*rectifier_;
}

Result<std::shared_ptr<const StereoRig>> RectifyParams::FindRig(
    const Environment& environment) const {
  if (!rig_->empty()) {
    if (environment.rigs != nullptr) return environment.rigs->Find(*rig_);
    return FailedPrecondition("there is no store of calibrations here; set rig_file instead");
  }
  if (rig_file_->empty()) {
    return FailedPrecondition(
        "no calibration is chosen; set rig to the name of a stored one, or rig_file to a file");
  }
  VS_ASSIGN_OR_RETURN(const std::filesystem::path file, DataPath(environment.folders, *rig_file_));
  VS_ASSIGN_OR_RETURN(StereoRig loaded, LoadRig(file));
  return std::make_shared<const StereoRig>(std::move(loaded));
}

RectifyOptions RectifyParams::Options() const {
  return {.alpha = *alpha_,
          .interpolation = *interpolation_ == "nearest" ? Interpolation::kNearest
                           : *interpolation_ == "cubic" ? Interpolation::kCubic
                                                        : Interpolation::kLinear,
          .exact_maps = *precision_ == "float",
          .half_size = *resolution_ == "half"};
}

}  // namespace vs
