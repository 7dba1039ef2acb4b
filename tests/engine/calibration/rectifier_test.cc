#include "engine/calibration/rectifier.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <memory>
#include <vector>

#include "engine/image/buffer.h"
#include "tests/engine/calibration/sample_rig.h"

namespace vs {
namespace {

using testing::HasSubstr;

struct Pixel {
  double x, y;
};
using Point = std::array<double, 3>;

Point Rotate(const std::array<double, 9>& r, const Point& p) {
  return {r[0] * p[0] + r[1] * p[1] + r[2] * p[2], r[3] * p[0] + r[4] * p[1] + r[5] * p[2],
          r[6] * p[0] + r[7] * p[1] + r[8] * p[2]};
}

// Where a camera with distortion sees a point of its own frame, in pictures of this scale.
Pixel Project(const CameraModel& c, const Point& p, double scale) {
  const double x = p[0] / p[2];
  const double y = p[1] / p[2];
  const double r2 = x * x + y * y;
  const double radial = 1 + r2 * (c.k1 + r2 * (c.k2 + r2 * c.k3));
  const double xd = x * radial + 2 * c.p1 * x * y + c.p2 * (r2 + 2 * x * x);
  const double yd = y * radial + c.p1 * (r2 + 2 * y * y) + 2 * c.p2 * x * y;
  return {(c.fx_px * xd + c.cx_px + 0.5) * scale - 0.5,
          (c.fy_px * yd + c.cy_px + 0.5) * scale - 0.5};
}

void DrawDot(Pixel centre, GreyImage* image) {
  constexpr double kSigma = 2.5;
  for (int y = static_cast<int>(centre.y) - 12; y <= centre.y + 12; ++y) {
    for (int x = static_cast<int>(centre.x) - 12; x <= centre.x + 12; ++x) {
      if (x < 0 || y < 0 || x >= image->width() || y >= image->height()) continue;
      const double r2 = (x - centre.x) * (x - centre.x) + (y - centre.y) * (y - centre.y);
      image->Row(y)[x] = static_cast<uint8_t>(
          std::lround(image->Row(y)[x] + 250 * std::exp(-r2 / (2 * kSigma * kSigma))));
    }
  }
}

// The centre of what is bright within 10 px.
Pixel FindDot(const GreyImage& image, Pixel near) {
  double sum = 0;
  Pixel centre{0, 0};
  for (int y = static_cast<int>(near.y) - 10; y <= near.y + 10; ++y) {
    for (int x = static_cast<int>(near.x) - 10; x <= near.x + 10; ++x) {
      if (x < 0 || y < 0 || x >= image.width() || y >= image.height()) continue;
      sum += image.Row(y)[x];
      centre.x += x * image.Row(y)[x];
      centre.y += y * image.Row(y)[x];
    }
  }
  return {centre.x / sum, centre.y / sum};
}

class RectifierTest : public testing::Test {
 protected:
  static FramePtr MakeFrame(GreyImage image) {
    auto frame = std::make_shared<Frame>();
    frame->image = std::move(image);
    frame->camera = "21000001";
    frame->number = 7;
    return frame;
  }
  GreyImage Black(int width, int height) {
    GreyImage image(pool_, width, height);
    image.Fill(0);
    return image;
  }

  // Draws points as both cameras see them at this scale, rectifies, and compares with the ideal
  // pair.
  void ExpectIdealPair(int width, int height, double scale, const RectifyOptions& options,
                       const StereoRig& rig = SampleRig()) {
    const auto rectifier = Rectifier::Make(rig, width, height, options);
    ASSERT_TRUE(rectifier.has_value()) << rectifier.error().ToString();
    const RectifiedGeometry& g = rectifier->geometry();
    EXPECT_EQ(g.width, options.half_size ? width / 2 : width);
    EXPECT_EQ(g.height, options.half_size ? height / 2 : height);
    EXPECT_NEAR(g.baseline_m, 0.12, 0.0001);
    std::vector<Point> points;
    GreyImage left = Black(width, height);
    GreyImage right = Black(width, height);
    for (int i = -2; i <= 2; ++i) {
      for (int j = -2; j <= 2; ++j) {
        const Point p = {0.05 + 0.14 * i, 0.12 * j, 0.9 + 0.04 * (i + j)};
        Point q = Rotate(rig.right_from_left_rotation, p);
        for (size_t k = 0; k < 3; ++k) q[k] += rig.right_from_left_translation_m[k];
        points.push_back(p);
        DrawDot(Project(rig.left, p, scale), &left);
        DrawDot(Project(rig.right, q, scale), &right);
      }
    }
    StereoFrame raw{.left = MakeFrame(left), .right = MakeFrame(right), .number = 9};
    const auto pair = rectifier->Rectify(raw, pool_);
    ASSERT_TRUE(pair.has_value()) << pair.error().ToString();
    double worst_row = 0;
    double worst_place = 0;
    for (const Point& p : points) {
      const Point r = Rotate(rectifier->rectified_from_left_rotation(), p);
      const Pixel ideal_left{g.focal_px * r[0] / r[2] + g.cx_px,
                             g.focal_px * r[1] / r[2] + g.cy_px};
      const double disparity = g.focal_px * g.baseline_m / r[2] - g.principal_offset_px;
      const Pixel ideal_right{ideal_left.x - disparity, ideal_left.y};
      const Pixel l = FindDot(pair->left->image, ideal_left);
      const Pixel q = FindDot(pair->right->image, ideal_right);
      worst_row = std::max(worst_row, std::abs(l.y - q.y));
      for (const double error :
           {l.x - ideal_left.x, l.y - ideal_left.y, q.x - ideal_right.x, q.y - ideal_right.y}) {
        worst_place = std::max(worst_place, std::abs(error));
      }
    }
    EXPECT_LT(worst_row, 0.05) << "px between the rows of the two views";
    EXPECT_LT(worst_place, 0.05) << "px from where the geometry says";
  }

  BufferPool pool_;
};

TEST_F(RectifierTest, PutsEachPointIntoOneRowWhereTheGeometrySays) {
  ExpectIdealPair(1296, 966, 1, {});
}

// The calibrated 966 rows hold 241.5 groups of four: the camera leaves the half one out. 483 binned
// rows are odd, so some cameras send 482.
TEST_F(RectifierTest, ServesBinnedPicturesOfTheSameRig) {
  ExpectIdealPair(648, 483, 1.0 / 2, {});
  ExpectIdealPair(648, 482, 1.0 / 2, {});
  ExpectIdealPair(432, 322, 1.0 / 3, {});
  ExpectIdealPair(324, 241, 1.0 / 4, {});
  ExpectIdealPair(324, 240, 1.0 / 4, {});
}

// Binning rounds columns as it rounds rows: 1297 / 2 and 1297 / 3 leave one column over.
TEST_F(RectifierTest, ServesPicturesWhoseColumnsBinningRounds) {
  StereoRig rig = SampleRig();
  rig.left.width = rig.right.width = 1297;
  ExpectIdealPair(648, 483, 1.0 / 2, {}, rig);
  ExpectIdealPair(432, 322, 1.0 / 3, {}, rig);
}

TEST_F(RectifierTest, TheFocalLengthOfBinnedPicturesIsThatOfTheRigDivided) {
  StereoRig rig = SampleRig();
  for (CameraModel* camera : {&rig.left, &rig.right}) {
    *camera = {
        .width = 1296, .height = 966, .fx_px = 1600, .fy_px = 1600, .cx_px = 647.5, .cy_px = 480.5};
  }
  rig.right_from_left_rotation = {1, 0, 0, 0, 1, 0, 0, 0, 1};
  rig.right_from_left_translation_m = {-0.12, 0, 0};
  const auto geometry = [&rig](int width, int height) {
    const auto rectifier = Rectifier::Make(rig, width, height);
    EXPECT_TRUE(rectifier.has_value()) << rectifier.error().ToString();
    return rectifier ? rectifier->geometry() : RectifiedGeometry();
  };
  EXPECT_NEAR(geometry(648, 482).focal_px, 800, 1e-6);
  EXPECT_NEAR(geometry(324, 241).focal_px, 400, 1e-6);
}

TEST_F(RectifierTest, MayShowEverythingOrInterpolateCubically) {
  ExpectIdealPair(1296, 966, 1, {.alpha = 1, .interpolation = Interpolation::kCubic});
}

TEST_F(RectifierTest, TakesPlacesFromExactMapsToo) {
  ExpectIdealPair(1296, 966, 1, {.exact_maps = true});
  ExpectIdealPair(1296, 966, 1,
                  {.alpha = 1, .interpolation = Interpolation::kCubic, .exact_maps = true});
}

TEST_F(RectifierTest, MayHalveThePictures) {
  ExpectIdealPair(1296, 966, 1, {.half_size = true});
  ExpectIdealPair(648, 483, 1.0 / 2, {.exact_maps = true, .half_size = true});
}

// What lies between the pixels of the half picture must not come through as a pattern that is not
// there: stripes of one pixel become an even grey.
TEST_F(RectifierTest, HalvingDoesNotAlias) {
  GreyImage stripes(pool_, 1296, 966);
  for (int y = 0; y < 966; ++y) {
    for (int x = 0; x < 1296; ++x) stripes.Row(y)[x] = x % 2 == 0 ? 200 : 100;
  }
  const auto rectifier = Rectifier::Make(SampleRig(), 1296, 966, {.half_size = true});
  const auto pair =
      rectifier->Rectify({.left = MakeFrame(stripes), .right = MakeFrame(stripes)}, pool_);
  ASSERT_TRUE(pair.has_value()) << pair.error().ToString();
  for (int y = 50; y < 430; ++y) {
    for (int x = 50; x < 600; ++x) ASSERT_EQ(pair->left->image.Row(y)[x], 150) << x << " " << y;
  }
}

TEST_F(RectifierTest, RefusesToHalveTinyPictures) {
  StereoRig rig = SampleRig();
  for (CameraModel* camera : {&rig.left, &rig.right}) {
    *camera = {.width = 30, .height = 30, .fx_px = 40, .fy_px = 40, .cx_px = 14.5, .cy_px = 14.5};
  }
  const auto rectifier = Rectifier::Make(rig, 30, 30, {.half_size = true});
  ASSERT_FALSE(rectifier.has_value());
  EXPECT_THAT(rectifier.error().message(), HasSubstr("too small to be halved"));
}

TEST_F(RectifierTest, KeepsWhatIsKnownOfThePairAndDropsItsTruth) {
  const auto rectifier = Rectifier::Make(SampleRig(), 648, 483);
  StereoFrame raw{.left = MakeFrame(Black(648, 483)),
                  .right = MakeFrame(Black(648, 483)),
                  .number = 9,
                  .skew_ns = 1234};
  raw.truth = std::make_shared<StereoTruth>();
  const auto pair = rectifier->Rectify(raw, pool_);
  ASSERT_TRUE(pair.has_value());
  EXPECT_EQ(pair->number, 9u);
  EXPECT_EQ(pair->skew_ns, 1234);
  EXPECT_EQ(pair->left->number, 7u);
  EXPECT_EQ(pair->left->camera, "21000001");
  EXPECT_EQ(pair->geometry, rectifier->geometry());
  EXPECT_EQ(pair->truth, nullptr);
}

TEST_F(RectifierTest, SaysWhichPictureHasTheWrongSize) {
  const auto rectifier = Rectifier::Make(SampleRig(), 648, 483);
  const StereoFrame raw{.left = MakeFrame(Black(648, 483)), .right = MakeFrame(Black(1296, 966))};
  const auto pair = rectifier->Rectify(raw, pool_);
  ASSERT_FALSE(pair.has_value());
  EXPECT_EQ(pair.error().ToString(),
            "INVALID_ARGUMENT: rectification: camera 21000001 gave 1296 x 966 px, expected 648 x "
            "483 px; set both cameras to the same size");
  EXPECT_EQ(rectifier->Rectify({.left = raw.left}, pool_).error().code(),
            StatusCode::kInvalidArgument);
}

TEST_F(RectifierTest, RefusesWhatItCannotServe) {
  const auto other_view = Rectifier::Make(SampleRig(), 648, 400);
  ASSERT_FALSE(other_view.has_value());
  EXPECT_EQ(
      other_view.error().message(),
      "stereo rig \"sample\" is calibrated for 1296 x 966 px, the pictures have 648 x 400 px; "
      "use the full picture, binned alike in both directions if needed, resize pictures after "
      "rectification only, or calibrate again");
  struct Size {
    int width, height;
  };
  // A row or column off; resized with rounding; binned 2 x 1.
  for (const auto& [width, height] :
       {Size{1296, 965}, Size{1295, 966}, Size{648, 481}, Size{647, 483}, Size{324, 242},
        Size{1037, 773}, Size{648, 966}, Size{8, 6}}) {
    EXPECT_EQ(Rectifier::Make(SampleRig(), width, height).error().code(),
              StatusCode::kInvalidArgument)
        << width << " x " << height;
  }

  StereoRig unequal = SampleRig();
  unequal.right.width = 1300;
  EXPECT_THAT(Rectifier::Make(unequal, 1296, 966).error().message(),
              HasSubstr("only equal cameras"));
  EXPECT_THAT(Rectifier::Make(SampleRig(), 1296, 966, {.alpha = 1.5}).error().message(),
              HasSubstr("alpha is 1.5"));
  StereoRig broken = SampleRig();
  broken.left.fx_px = 0;
  EXPECT_EQ(Rectifier::Make(broken, 1296, 966).error().code(), StatusCode::kInvalidArgument);
}

}  // namespace
}  // namespace vs
