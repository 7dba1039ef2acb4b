// Undoes lens distortion and misalignment of a pair of cameras by their calibration.
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "engine/calibration/rectifier.h"
#include "engine/calibration/rig_file.h"
#include "engine/core/block.h"

namespace vs {
namespace {

class RectifyPair final : public Block {
 public:
  In<StereoFrame> pair{this, "pair", "The pair as the cameras took it."};
  Out<StereoFrame> rectified{this, "rectified",
                             "The pair as two ideal, parallel cameras would see it: a point lies "
                             "in the same row of both pictures."};
  Param<std::string> rig{
      this,
      "rig",
      {.live = false,
       .doc =
           "Name of the stored calibration of these two cameras. Leave it empty to use a file."}};
  Param<std::string> rig_file{
      this,
      "rig_file",
      {.live = false,
       .doc = "Calibration file below the server's data folder, used when no stored calibration "
              "is named."}};
  Param<double> alpha{
      this,
      "alpha",
      {.initial = 0,
       .min = 0.0,
       .max = 1.0,
       .doc = "How much to show: 0 only what lies inside both pictures, 1 everything, with "
              "black borders."}};
  Param<std::string> interpolation{
      this,
      "interpolation",
      {.initial = "linear",
       .choices = {"nearest", "linear", "cubic"},
       .doc = "How a grey value between pixels is found; cubic is sharper and slower."}};

  Param<std::string> precision{
      this,
      "precision",
      {.initial = "fixed",
       .choices = {"fixed", "float"},
       .doc = "How exactly the place of each pixel is known: fixed is 1/32 px and quicker; float "
              "takes a faint ripple out of depth."}};
  Param<std::string> resolution{
      this,
      "resolution",
      {.initial = "full",
       .choices = {"full", "half"},
       .doc = "With half the pictures are binned first, each pixel the mean of four: four times as "
              "quick to match, half as fine."}};

  Status Start() override {
    rectifier_.reset();
    VS_ASSIGN_OR_RETURN(rig_, FindRig());
    return {};
  }

  Status Run() override {
    if (pair->geometry) {
      return FailedPrecondition("this pair is rectified already; remove this block");
    }
    if (pair->left == nullptr) return InvalidArgument("the pair has no left picture");
    VS_RETURN_IF_ERROR(PrepareFor(pair->left->image));
    VS_ASSIGN_OR_RETURN(StereoFrame result, rectifier_->Rectify(*pair, pool()));
    rectified.Set(std::move(result));
    return {};
  }

 private:
  Result<std::shared_ptr<const StereoRig>> FindRig() const {
    if (!rig->empty()) {
      if (environment().rigs != nullptr) return environment().rigs->Find(*rig);
      return FailedPrecondition("there is no store of calibrations here; set rig_file instead");
    }
    if (rig_file->empty()) {
      return FailedPrecondition(
          "no calibration is chosen; set rig to the name of a stored one, or rig_file to a file");
    }
    VS_ASSIGN_OR_RETURN(const std::filesystem::path file,
                        DataPath(environment().folders, *rig_file));
    VS_ASSIGN_OR_RETURN(StereoRig loaded, LoadRig(file));
    return std::make_shared<const StereoRig>(std::move(loaded));
  }

  // The maps depend on the size of the pictures, which only the first pair tells.
  Status PrepareFor(const GreyImage& image) {
    const RectifyOptions options{.alpha = *alpha,
                                 .interpolation = ChosenInterpolation(),
                                 .exact_maps = *precision == "float",
                                 .half_size = *resolution == "half"};
    if (rectifier_ && rectifier_->Fits(image) && options == options_) return {};
    VS_ASSIGN_OR_RETURN(rectifier_, Rectifier::Make(*rig_, image.width(), image.height(), options));
    options_ = options;
    return {};
  }

  Interpolation ChosenInterpolation() const {
    if (*interpolation == "nearest") return Interpolation::kNearest;
    return *interpolation == "cubic" ? Interpolation::kCubic : Interpolation::kLinear;
  }

  std::shared_ptr<const StereoRig> rig_;
  std::optional<Rectifier> rectifier_;
  RectifyOptions options_;
};

VS_REGISTER_BLOCK(
    RectifyPair,
    {.category = "Prepare",
     .doc = "Removes lens distortion and turns both views parallel, by the cameras' "
            "calibration. Matching needs such a pair. Takes pictures of the calibrated "
            "size or binned ones; a window of the sensor needs its own calibration."});

}  // namespace
}  // namespace vs
