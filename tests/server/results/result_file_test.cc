#include "server/results/result_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "tests/support/temp_folder.h"

namespace vs {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

class ResultFileTest : public ::testing::Test {
 protected:
  ResultFileTest() { fs::create_directories(data_dir_ / "images"); }

  void Write(const fs::path& file, const std::string& text) {
    std::ofstream(file, std::ios::binary) << text;
  }
  StatusCode CodeOf(const std::string& path) {
    const auto file = ReadResultFile(data_dir_, path);
    return file.has_value() ? StatusCode::kOk : file.error().code();
  }

  test::TempFolder folder_;
  const fs::path data_dir_ = folder_ / "data";
};

TEST_F(ResultFileTest, GivesPicturesAndCloudsBelowTheDataFolder) {
  const std::string bytes("\x89PNG\0\n", 6);
  Write(data_dir_ / "images/left.png", bytes);
  const auto picture = ReadResultFile(data_dir_, "images/left.png");
  ASSERT_TRUE(picture.has_value()) << picture.error().ToString();
  EXPECT_EQ(picture->name, "left.png");
  EXPECT_EQ(picture->media_type, "image/png");
  EXPECT_EQ(picture->data, bytes);
  Write(data_dir_ / "images/part.ply", "");
  EXPECT_EQ(ReadResultFile(data_dir_, "images/part.ply")->media_type, "model/ply");
}

TEST_F(ResultFileTest, RefusesWhatLiesElsewhere) {
  Write(folder_ / "secret.png", "secret");
  Write(data_dir_ / "users.db", "secret");
  fs::create_symlink("../../secret.png", data_dir_ / "images/link.png");
  fs::create_symlink("../users.db", data_dir_ / "images/users.png");
  fs::create_directory_symlink("..", data_dir_ / "up");
  for (const char* path :
       {"../secret.png", "images/../../secret.png", "images/link.png", "images/users.png",
        "up/secret.png", "users.db", "images", "", ".", "/etc/hostname", "images/.png"}) {
    EXPECT_EQ(CodeOf(path), StatusCode::kInvalidArgument) << path;
  }
  EXPECT_EQ(CodeOf((folder_ / "secret.png").string()), StatusCode::kInvalidArgument);
  EXPECT_EQ(CodeOf((data_dir_ / "images/left.png").string()), StatusCode::kInvalidArgument);
}

TEST_F(ResultFileTest, GivesRegularFilesOnly) {
  fs::create_directories(data_dir_ / "folder.png");
  EXPECT_EQ(CodeOf("folder.png"), StatusCode::kInvalidArgument);
  ASSERT_EQ(mkfifo((data_dir_ / "pipe.png").c_str(), 0600), 0);
  EXPECT_EQ(CodeOf("pipe.png"), StatusCode::kInvalidArgument);
}

TEST_F(ResultFileTest, SaysWhenItWasRemoved) {
  const auto file = ReadResultFile(data_dir_, "images/gone.png");
  ASSERT_FALSE(file.has_value());
  EXPECT_EQ(file.error().code(), StatusCode::kNotFound);
  EXPECT_THAT(file.error().message(), HasSubstr("\"images/gone.png\" is not there"));
}

TEST_F(ResultFileTest, SaysWhenItIsTooLarge) {
  Write(data_dir_ / "large.ply", "x");
  fs::resize_file(data_dir_ / "large.ply", kMaxResultFileBytes);
  EXPECT_EQ(CodeOf("large.ply"), StatusCode::kOk);
  fs::resize_file(data_dir_ / "large.ply", kMaxResultFileBytes + 1);
  EXPECT_EQ(CodeOf("large.ply"), StatusCode::kResourceExhausted);
}

}  // namespace
}  // namespace vs
