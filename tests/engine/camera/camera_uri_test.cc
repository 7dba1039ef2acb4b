#include "engine/camera/camera_uri.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "engine/camera/camera_source.h"

namespace vs {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Pair;

CameraUri MustParse(std::string_view text) {
  auto uri = CameraUri::Parse(text);
  EXPECT_TRUE(uri.has_value()) << uri.error().ToString();
  return uri.value_or(CameraUri());
}

TEST(CameraUri, TakesSchemeAddressAndOptionsApart) {
  const CameraUri uri = MustParse("file:/data/run7?pattern=*_left.png&loop=true&fps=30");
  EXPECT_EQ(uri.scheme, "file");
  EXPECT_EQ(uri.address, "/data/run7");
  EXPECT_THAT(uri.options,
              ElementsAre(Pair("pattern", "*_left.png"), Pair("loop", "true"), Pair("fps", "30")));
  EXPECT_EQ(uri.Option("fps"), "30");
  EXPECT_EQ(uri.Option("speed"), std::nullopt);
}

TEST(CameraUri, KeepsTheOrderOfFeaturesBecauseSelectorsDependOnIt) {
  const CameraUri uri = MustParse(
      "gev:21000001?TriggerSelector=FrameStart&TriggerMode=On&buffers=8&"
      "TriggerSelector=AcquisitionStart&TriggerMode=Off");
  EXPECT_THAT(uri.Features(),
              ElementsAre(Pair("TriggerSelector", "FrameStart"), Pair("TriggerMode", "On"),
                          Pair("TriggerSelector", "AcquisitionStart"), Pair("TriggerMode", "Off")));
}

TEST(CameraUri, KeepsAHashInTheAddress) {
  EXPECT_EQ(MustParse("sim:demo#left?seed=3").address, "demo#left");
}

TEST(CameraUri, EscapesWhatWouldBeReadOtherwise) {
  CameraUri uri;
  uri.scheme = "file";
  uri.address = "/data/50% off?/a b";
  uri.options = {{"pattern", "a&b=?.png"}};
  EXPECT_EQ(uri.ToString(), "file:/data/50%25%20off%3F/a%20b?pattern=a%26b=?.png");
  EXPECT_EQ(MustParse(uri.ToString()), uri);
}

TEST(CameraUri, NamesWhatIsWrong) {
  const std::pair<const char*, const char*> cases[] = {
      {"", "scheme:address"},
      {"21000001", "scheme:address"},
      {":21000001", "scheme:address"},
      {"GEV:21000001", "lower-case"},
      {"gev:", "no address after 'gev:'"},
      {"gev:?Width=1", "no address"},
      {"gev:1?Width", "\"Width\" is not a key=value"},
      {"gev:1?=5", "\"=5\" is not a key=value"},
      {"gev:1?a=1&a=2", "gives a twice"},
      {"gev:1%2", "two hex digits"},
      {"gev:1?a=%zz", "two hex digits"},
  };
  for (const auto& [text, expected] : cases) {
    const auto uri = CameraUri::Parse(text);
    ASSERT_FALSE(uri.has_value()) << text;
    EXPECT_EQ(uri.error().code(), StatusCode::kInvalidArgument) << text;
    EXPECT_THAT(uri.error().message(), HasSubstr(expected)) << text;
  }
}

TEST(UriOptions, GivesValuesAndDefaults) {
  const CameraUri uri = MustParse("file:/d?loop=1&fps=12.5&buffers=9&pattern=x");
  UriOptions options(uri);
  EXPECT_TRUE(options.Flag("loop", false));
  EXPECT_EQ(options.Number("fps", 0, 0, 1000), 12.5);
  EXPECT_EQ(options.Integer("buffers", 8, 3, 64), 9);
  EXPECT_EQ(options.Text("pattern", "*"), "x");
  EXPECT_EQ(options.Text("depth", "8 bit"), "8 bit");
  EXPECT_TRUE(options.Check().ok());
}

TEST(UriOptions, NamesEveryBadAndUnknownOptionAtOnce) {
  const CameraUri uri = MustParse("file:/d?loop=maybe&fps=1e9&bufers=8&Width=5");
  UriOptions options(uri);
  EXPECT_FALSE(options.Flag("loop", false));
  EXPECT_EQ(options.Number("fps", 30, 0, 1000), 30);
  const Status status = options.Check();
  EXPECT_EQ(status.code(), StatusCode::kInvalidArgument);
  EXPECT_THAT(status.faults(),
              ElementsAre(Fault{"loop", "\"maybe\" is not true or false"},
                          Fault{"fps", "\"1e9\" is not a number from 0 to 1000"},
                          Fault{"bufers", "unknown option of file:; there are loop, fps"}));
}

TEST(CameraDrivers, NamesTheSchemesThatThereAre) {
  const auto camera = CameraDrivers::Get().Make(MustParse("usb:1"));
  ASSERT_FALSE(camera.has_value());
  EXPECT_EQ(camera.error().code(), StatusCode::kNotFound);
  EXPECT_THAT(camera.error().message(), HasSubstr("\"usb:1\""));
}

}  // namespace
}  // namespace vs
