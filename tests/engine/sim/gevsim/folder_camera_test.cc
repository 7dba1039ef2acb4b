#include "engine/sim/gevsim/folder_camera.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "tests/support/temp_folder.h"

namespace vs::sim {
namespace {

class FolderPictures : public testing::Test {
 protected:
  // A picture of one grey level, in the simplest format there is.
  std::string WriteGrey(const std::string& name, int width, int height, uint8_t level) {
    std::string path = folder_.path() / name;
    std::ofstream(path, std::ios::binary)
        << "P5\n"
        << width << " " << height << "\n255\n"
        << std::string(static_cast<size_t>(width) * height, static_cast<char>(level));
    return path;
  }
  int LevelAt(FolderCamera& camera, int64_t instant_ns) {
    const SensorSettings settings = camera.DefaultSettings();
    GreyImage picture(pool_, settings.width, settings.height);
    camera.Capture(instant_ns, settings, picture);
    EXPECT_EQ(picture.Row(0)[0], picture.Row(settings.height - 1)[settings.width - 1]);
    return picture.Row(0)[0];
  }

  test::TempFolder folder_;
  BufferPool pool_;
};

TEST_F(FolderPictures, AreListedByPatternAndName) {
  const std::string b = WriteGrey("b_left.pgm", 4, 4, 1);
  const std::string a = WriteGrey("a_left.pgm", 4, 4, 1);
  WriteGrey("a_right.pgm", 4, 4, 1);
  EXPECT_EQ(ListPictures(folder_.path(), "*left*"), (std::vector<std::string>{a, b}));
  EXPECT_TRUE(ListPictures(folder_.path() / "nowhere", "*").empty());
}

TEST_F(FolderPictures, AreShownUnchangedAndInTurn) {
  const auto camera = FolderCamera::Load(
      {WriteGrey("0", 33, 21, 10), WriteGrey("1", 33, 21, 128), WriteGrey("2", 33, 21, 255)},
      100'000'000, {0, 1});
  ASSERT_TRUE(camera.has_value()) << camera.error().ToString();
  EXPECT_EQ((*camera)->width(), 33);
  EXPECT_EQ((*camera)->height(), 21);
  EXPECT_EQ(LevelAt(**camera, 0), 10);
  EXPECT_EQ(LevelAt(**camera, 100'000'001), 128);
  EXPECT_EQ(LevelAt(**camera, 199'999'999), 255);
  EXPECT_EQ(LevelAt(**camera, 9'000'000'000'000'000'000), 10);  // after 285 years
  EXPECT_EQ(LevelAt(**camera, 300'000'000), 10);
}

TEST_F(FolderPictures, MustBeReadableAndOfOneSize) {
  const std::string good = WriteGrey("good.pgm", 8, 8, 10);
  const std::string other = WriteGrey("other.pgm", 8, 9, 10);
  const std::string broken = folder_.path() / "broken.png";
  std::ofstream(broken) << "this is no picture";
  for (const std::string& bad : {other, broken, std::string("/nowhere/at/all.png")}) {
    const auto camera = FolderCamera::Load({good, bad}, 100'000'000, {0, 1});
    ASSERT_FALSE(camera.has_value());
    EXPECT_EQ(camera.error().code(), StatusCode::kInvalidArgument);
    EXPECT_NE(camera.error().message().find(bad), std::string::npos) << camera.error().message();
  }
  EXPECT_FALSE(FolderCamera::Load({}, 100'000'000, {0, 1}).has_value());
}

}  // namespace
}  // namespace vs::sim
