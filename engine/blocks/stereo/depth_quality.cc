// Figures that say how good a depth picture is.
#include "engine/core/block.h"
#include "engine/core/region_params.h"
#include "engine/stereo/plane_fit.h"
#include "engine/stereo/quality.h"

namespace vs {
namespace {

class DepthQuality final : public Block {
 public:
  In<DisparityMap> disparity{this, "disparity", "The disparity map to judge."};
  In<DepthMap> depth{this, "depth", "Its depth, for the plane figures.", Need::kOptional};
  In<StereoFrame> pair{
      this, "pair",
      "The pair that was matched. If its source knows the truth, as the simulation "
      "does, the errors are measured against it.",
      Need::kOptional};
  Out<double> valid{this, "valid", "Share of the region's pixels that have a disparity, %."};
  Out<double> plane_rms{this, "plane_rms",
                        "How far the region's points lie from their best plane (root mean square "
                        "without outliers), m. Missing where there is no plane."};
  Out<double> plane_distance{this, "plane_distance",
                             "Distance of that plane from the left camera, m."};
  Out<double> bad1{this, "bad1",
                   "Share of the visible pixels that are invalid or more than 1 px off, %. Only "
                   "with truth."};
  Out<double> bad2{this, "bad2",
                   "Share of the visible pixels that are invalid or more than 2 px off, %. Only "
                   "with truth."};
  Out<double> average_error{this, "average_error",
                            "Mean error of the valid pixels, px. Only with truth."};
  Out<double> depth_bias{this, "depth_bias",
                         "Mean relative error of depth, % (positive: measured too far). Only with "
                         "truth."};
  RegionParams region{this, "The region that is judged."};

  Status Run() override {
    valid.Set(ValidPercent(*disparity, *region));
    if (depth.has_value()) {
      // A region without a plane is an answer, not a failure: the figures are missing.
      if (const Result<PlaneFit> fit = FitPlane(*depth, *region, pool())) {
        plane_rms.Set(fit->rms_m);
        plane_distance.Set(fit->distance_m);
      }
    }
    if (!pair.has_value() || pair->truth == nullptr) return {};
    VS_ASSIGN_OR_RETURN(const TruthScore score,
                        ScoreAgainstTruth(*disparity, *pair->truth, *region));
    bad1.Set(score.bad1_percent);
    bad2.Set(score.bad2_percent);
    average_error.Set(score.average_error_px);
    depth_bias.Set(score.depth_bias_percent);
    return {};
  }
};

VS_REGISTER_BLOCK(DepthQuality,
                  {.category = "Stereo",
                   .doc = "Measures a depth picture: how complete it is, how flat a plane comes "
                          "out, and its errors where the truth is known."});

}  // namespace
}  // namespace vs
