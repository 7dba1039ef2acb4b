// Plays recorded pairs of pictures.
#include <memory>
#include <utility>

#include "engine/camera/file_pair_source.h"
#include "engine/camera/intake.h"
#include "engine/core/block.h"

namespace vs {
namespace {

class FileSource final : public Block {
 public:
  Out<StereoFrame> pair{this, "pair",
                        "Two pictures that belong together, with their truth where there is one."};
  Param<std::string> folder{
      this,
      "folder",
      {.live = false,
       .doc = "Folder with the pictures: below the server's data folder, or an absolute path "
              "below a folder that the server's configuration names as picture_root."}};
  Param<std::string> left{
      this,
      "left",
      {.live = false,
       .doc = "Names of the left pictures with at most one *, for example *_left.png or "
              "left/*.png. Empty, with right empty too: names with the word left, and those with "
              "right instead."}};
  Param<std::string> right{
      this,
      "right",
      {.live = false,
       .doc = "Names of the right pictures; * stands for the same text as in the left name."}};
  Param<std::string> truth{
      this,
      "truth",
      {.live = false,
       .doc = "Names of true disparity pictures (16-bit PNG, px = value / 256, 0 unknown), if "
              "there are any."}};
  Param<std::string> visible{
      this,
      "visible",
      {.live = false,
       .doc = "Names of masks that are 255 where both cameras see the point, if there are any."}};
  Param<double> rate_hz{this,
                        "rate_hz",
                        {.initial = 0,
                         .min = 0.0,
                         .max = 1000.0,
                         .unit = "Hz",
                         .live = false,
                         .doc = "Pairs a second; 0 plays as fast as the sequence takes them."}};
  Param<bool> loop{
      this, "loop", {.initial = false, .live = false, .doc = "Begin again after the last pair."}};
  Param<bool> rectified{
      this,
      "rectified",
      {.initial = false,
       .live = false,
       .doc = "The pictures are rectified already, so that they can be matched as they are."}};
  Param<double> focal_px{this,
                         "focal_px",
                         {.initial = 0,
                          .min = 0.0,
                          .max = 100000.0,
                          .unit = "px",
                          .live = false,
                          .doc = "Focal length of rectified pictures; 0 if unknown, then there is "
                                 "disparity but no depth."}};
  Param<double> baseline_m{this,
                           "baseline_m",
                           {.initial = 0,
                            .min = 0.0,
                            .max = 100.0,
                            .unit = "m",
                            .live = false,
                            .doc = "Distance of the two cameras of rectified pictures."}};
  Param<double> center_x_px{this,
                            "center_x_px",
                            {.initial = 0,
                             .min = 0.0,
                             .max = 100000.0,
                             .unit = "px",
                             .live = false,
                             .doc = "Column of the optical axis in the left rectified picture."}};
  Param<double> center_y_px{this,
                            "center_y_px",
                            {.initial = 0,
                             .min = 0.0,
                             .max = 100000.0,
                             .unit = "px",
                             .live = false,
                             .doc = "Row of the optical axis in both rectified pictures."}};
  Param<double> offset_px{
      this,
      "offset_px",
      {.initial = 0,
       .min = -10000.0,
       .max = 10000.0,
       .unit = "px",
       .live = false,
       .doc = "Column of the right picture's optical axis minus that of the left "
              "one."}};

  Status Start() override {
    if (folder->empty()) return InvalidArgument("set folder to the folder with the pictures");
    FilePairOptions options;
    VS_ASSIGN_OR_RETURN(options.folder, PicturePath(environment().folders, *folder));
    options.left_pattern = *left;
    options.right_pattern = *right;
    options.truth_pattern = *truth;
    options.visible_pattern = *visible;
    options.play = {.fps = *rate_hz, .loop = *loop};
    if (*rectified) {
      options.geometry = RectifiedGeometry{.focal_px = *focal_px,
                                           .baseline_m = *baseline_m,
                                           .cx_px = *center_x_px,
                                           .cy_px = *center_y_px,
                                           .principal_offset_px = *offset_px};
    }
    return intake_.Start(MakeFilePairSource(std::move(options)));
  }

  bool Ready() override { return intake_.Available(); }

  Status Run() override {
    const auto read = intake_.TryTake();
    if (!read) return {};
    frame().source_number = (*read)->number;
    frame().capture_ns = (*read)->left->capture_ns;
    frame().arrival_ns = (*read)->left->arrival_ns;
    pair.Set(*read);
    return {};
  }

  void Stop() override { intake_.Stop(); }

  uint64_t Dropped() const override { return intake_.Dropped(); }

  SourceReport Report() const override { return intake_.Report(); }

 private:
  Intake<StereoSource, StereoFramePtr> intake_{[this] { Wake(); }};
};

VS_REGISTER_BLOCK(FileSource,
                  {.category = "Acquire",
                   .doc = "Plays recorded pairs of pictures from a folder on the server, each "
                          "exactly once or over and over. None is dropped."});

}  // namespace
}  // namespace vs
