// Shrinks or grows both pictures of a pair.
#include "engine/calibration/resize_pair.h"
#include "engine/core/block.h"

namespace vs {
namespace {

class Resize final : public Block {
 public:
  In<StereoFrame> pair{this, "pair", "The pair of pictures."};
  Out<StereoFrame> resized{this, "resized", "The same pair at the new size."};
  Param<double> scale{this,
                      "scale",
                      {.initial = 0.5,
                       .min = 0.05,
                       .max = 4.0,
                       .doc = "New size over old size; 0.5 averages 2 x 2 pixels, as a camera's "
                              "binning does."}};

  Status Run() override {
    VS_ASSIGN_OR_RETURN(StereoFrame result, ResizePair(*pair, *scale, frames_, pool()));
    resized.Set(std::move(result));
    return {};
  }

 private:
  Recycler<Frame> frames_;
};

VS_REGISTER_BLOCK(Resize,
                  {.category = "Prepare",
                   .doc = "Shrinks or grows both pictures of a pair. Smaller pictures are matched "
                          "faster; depth becomes coarser in proportion."});

}  // namespace
}  // namespace vs
