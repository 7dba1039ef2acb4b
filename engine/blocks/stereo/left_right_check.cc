// Invalidates every disparity whose counterpart in the other view disagrees.
#include "engine/stereo/left_right_check.h"

#include <utility>

#include "engine/core/block.h"

namespace vs {
namespace {

class LeftRightCheck final : public Block {
 public:
  In<DisparityMap> left{this, "left", "Disparity of the left view."};
  In<DisparityMap> right{this, "right", "Disparity of the right view (SgmStereo, view right)."};
  Out<DisparityMap> checked{this, "checked", "Left disparity, invalid where the two disagree."};
  Param<double> max_difference{this,
                               "max_difference",
                               {.initial = 1,
                                .min = 0.0,
                                .max = 8.0,
                                .unit = "px",
                                .operator_editable = true,
                                .doc = "Largest difference that still counts as agreement."}};

  Status Run() override {
    VS_ASSIGN_OR_RETURN(DisparityMap map, CheckLeftRight(*left, *right, *max_difference, pool()));
    checked.Set(std::move(map));
    return {};
  }
};

VS_REGISTER_BLOCK(LeftRightCheck,
                  {.category = "Stereo",
                   .doc = "Keeps only disparities on which both views agree, which finds what is "
                          "hidden from one camera."});

}  // namespace
}  // namespace vs
