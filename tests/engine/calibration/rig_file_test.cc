#include "engine/calibration/rig_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include "engine/calibration/rig_json.h"
#include "tests/engine/calibration/sample_rig.h"
#include "tests/support/temp_folder.h"

namespace vs {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

class RigFile : public testing::Test {
 protected:
  std::filesystem::path Path(const std::string& name) const { return folder_.path() / name; }
  static std::string TextOf(const std::filesystem::path& path) {
    std::ifstream file(path);
    return {std::istreambuf_iterator<char>(file), {}};
  }
  size_t FilesInFolder() const {
    return static_cast<size_t>(std::distance(std::filesystem::directory_iterator(folder_.path()),
                                             std::filesystem::directory_iterator()));
  }

  test::TempFolder folder_;
};

TEST_F(RigFile, IsLoadedAsItWasSaved) {
  ASSERT_TRUE(SaveRig(SampleRig(), Path("rig.json")).ok());
  const auto rig = LoadRig(Path("rig.json"));
  ASSERT_TRUE(rig.has_value()) << rig.error().ToString();
  EXPECT_EQ(*rig, SampleRig());
  EXPECT_EQ(FilesInFolder(), 1u) << "nothing temporary stays";
}

TEST_F(RigFile, SavingReplacesTheOldFileWhole) {
  std::ofstream(Path("rig.json")) << std::string(100000, 'x');
  ASSERT_TRUE(SaveRig(SampleRig(), Path("rig.json")).ok());
  EXPECT_EQ(TextOf(Path("rig.json")), FormatRig(SampleRig()));
}

TEST_F(RigFile, AnInvalidRigLeavesTheOldFileAlone) {
  ASSERT_TRUE(SaveRig(SampleRig(), Path("rig.json")).ok());
  StereoRig broken = SampleRig();
  broken.left.fx_px = 0;
  EXPECT_EQ(SaveRig(broken, Path("rig.json")).code(), StatusCode::kInvalidArgument);
  EXPECT_EQ(TextOf(Path("rig.json")), FormatRig(SampleRig()));
  EXPECT_EQ(FilesInFolder(), 1u);
}

TEST_F(RigFile, ErrorsBeginWithThePath) {
  const auto missing = LoadRig(Path("missing.json"));
  ASSERT_FALSE(missing.has_value());
  EXPECT_EQ(missing.error().code(), StatusCode::kNotFound);
  EXPECT_THAT(missing.error().message(), StartsWith(Path("missing.json").string()));

  std::ofstream(Path("broken.json")) << "{";
  const auto broken = LoadRig(Path("broken.json"));
  ASSERT_FALSE(broken.has_value());
  EXPECT_EQ(broken.error().code(), StatusCode::kInvalidArgument);
  EXPECT_THAT(broken.error().message(), StartsWith(Path("broken.json").string()));
}

TEST_F(RigFile, LoadsNeitherFoldersNorHugeFiles) {
  EXPECT_FALSE(LoadRig(folder_.path()).has_value());
  std::ofstream(Path("huge.json")) << std::string(1000000, ' ');
  const auto huge = LoadRig(Path("huge.json"));
  ASSERT_FALSE(huge.has_value());
  EXPECT_THAT(huge.error().message(), HasSubstr("longer than 65536 bytes"));
}

TEST_F(RigFile, SavingSaysWhyItCannot) {
  EXPECT_EQ(SaveRig(SampleRig(), Path("no/such/folder/rig.json")).code(), StatusCode::kNotFound);
  ASSERT_TRUE(std::filesystem::create_directory(Path("taken")));
  const Status status = SaveRig(SampleRig(), Path("taken"));
  EXPECT_FALSE(status.ok());
  EXPECT_THAT(status.message(), HasSubstr("cannot replace"));
  EXPECT_EQ(FilesInFolder(), 1u) << "nothing temporary stays";
}

}  // namespace
}  // namespace vs
