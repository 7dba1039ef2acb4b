#include "engine/image/picture_folder.h"

#include <gtest/gtest.h>

#include <fstream>
#include <set>
#include <string>
#include <vector>

#include "tests/support/temp_folder.h"

namespace vs {
namespace {

using Names = std::set<std::string>;

class PictureFolderTest : public ::testing::Test {
 protected:
  Names Files() const {
    Names names;
    for (const auto& file : std::filesystem::directory_iterator(root_ / "pictures")) {
      names.insert(file.path().filename().string());
    }
    return names;
  }
  Result<PictureFolder> Open() { return PictureFolder::Open(root_ / "pictures"); }

  test::TempFolder root_;
  const std::vector<uint8_t> kilobyte_ = std::vector<uint8_t>(1000, 7);
};

TEST_F(PictureFolderTest, RefusesMoreFilesOrBytesThanAllowed) {
  PictureFolder folder = Open().value();
  PictureFolder::Limits limits{2, 10'000};
  EXPECT_TRUE(folder.Write("b.png", kilobyte_, limits).ok());
  EXPECT_TRUE(folder.Write("a.png", kilobyte_, limits).ok());
  EXPECT_EQ(folder.Write("c.png", kilobyte_, limits).code(), StatusCode::kResourceExhausted);
  limits = {100, 2999};
  EXPECT_EQ(folder.Write("c.png", kilobyte_, limits).code(), StatusCode::kResourceExhausted);
  limits.max_bytes = 3000;
  EXPECT_TRUE(folder.Write("c.png", kilobyte_, limits).ok());
  EXPECT_EQ(Files(), (Names{"a.png", "b.png", "c.png"}));
  EXPECT_EQ(folder.bytes(), 3000);
  EXPECT_EQ(std::filesystem::file_size(root_ / "pictures/a.png"), 1000u);
}

TEST_F(PictureFolderTest, DeletesTheOldestWhenAskedTo) {
  PictureFolder folder = Open().value();
  const PictureFolder::Limits limits{2, 10'000, 0, true};
  for (const char* name : {"1.png", "2.png", "3.png", "4.png"}) {
    ASSERT_TRUE(folder.Write(name, kilobyte_, limits).ok());
  }
  EXPECT_EQ(Files(), (Names{"3.png", "4.png"}));
  const PictureFolder::Limits too_small{2, 999, 0, true};
  EXPECT_EQ(folder.Write("5.png", kilobyte_, too_small).code(), StatusCode::kResourceExhausted);
  EXPECT_EQ(Files(), (Names{"3.png", "4.png"})) << "deleting all would not help";
}

TEST_F(PictureFolderTest, CountsWhatIsThereAlready) {
  {
    PictureFolder folder = Open().value();
    ASSERT_TRUE(folder.Write("1.png", kilobyte_, {10, 10'000}).ok());
  }
  std::ofstream(root_ / "pictures/notes.txt") << "not a picture";
  PictureFolder folder = Open().value();
  EXPECT_EQ(folder.files(), 1);
  EXPECT_EQ(folder.bytes(), 1000);
  ASSERT_TRUE(folder.Write("2.png", kilobyte_, {1, 10'000, 0, true}).ok());
  EXPECT_EQ(Files(), (Names{"2.png", "notes.txt"}));
}

TEST_F(PictureFolderTest, KeepsSpaceFreeOnTheDisk) {
  PictureFolder folder = Open().value();
  const PictureFolder::Limits limits{10, 10'000, int64_t{1} << 60};
  const Status refused = folder.Write("1.png", kilobyte_, limits);
  EXPECT_EQ(refused.code(), StatusCode::kResourceExhausted);
  EXPECT_NE(refused.message().find("nearly full"), std::string::npos) << refused.message();
  EXPECT_EQ(Files(), Names{});
}

TEST_F(PictureFolderTest, LeavesNothingBehindWhenAFileCannotBeWritten) {
  PictureFolder folder = Open().value();
  std::filesystem::create_directories(root_ / "pictures/1.png/in_the_way");
  EXPECT_EQ(folder.Write("1.png", kilobyte_, {10, 10'000}).code(), StatusCode::kResourceExhausted);
  EXPECT_EQ(Files(), Names{"1.png"});
  EXPECT_EQ(folder.files(), 0);
}

TEST_F(PictureFolderTest, NamesAFolderThatCannotBe) {
  std::ofstream(root_ / "pictures") << "a file";
  EXPECT_EQ(Open().error().code(), StatusCode::kFailedPrecondition);
}

}  // namespace
}  // namespace vs
