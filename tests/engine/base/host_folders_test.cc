#include "engine/base/host_folders.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace vs {
namespace {

using ::testing::HasSubstr;

const HostFolders kFolders{.data_dir = "/var/lib/vs", .picture_roots = {"/srv/parts", "/mnt/nas/"}};

TEST(HostFolders, RelativePathsStartInTheDataFolderAndStayThere) {
  EXPECT_EQ(DataPath(kFolders, "rigs/a.json"), "/var/lib/vs/rigs/a.json");
  EXPECT_EQ(PicturePath(kFolders, "run7"), "/var/lib/vs/run7");
  EXPECT_EQ(PicturePath(kFolders, "..run"), "/var/lib/vs/..run") << "a name like any other";
  for (const char* out : {"..", "../x", "a/../../x", "a/..", ""}) {
    EXPECT_EQ(DataPath(kFolders, out).error().code(), StatusCode::kInvalidArgument) << out;
    EXPECT_EQ(PicturePath(kFolders, out).error().code(), StatusCode::kInvalidArgument) << out;
  }
  EXPECT_EQ(DataPath(kFolders, "../x").error().message(),
            "\"../x\" leads out of the server's data folder; give a path relative to it, without "
            "\"..\"");
}

TEST(HostFolders, OnlyPicturesMayLieElsewhereBelowARoot) {
  EXPECT_EQ(PicturePath(kFolders, "/srv/parts"), "/srv/parts");
  EXPECT_EQ(PicturePath(kFolders, "/srv/parts/run7"), "/srv/parts/run7");
  EXPECT_EQ(PicturePath(kFolders, "/mnt/nas/run7/"), "/mnt/nas/run7/");
  EXPECT_EQ(PicturePath(kFolders, "/var/lib/vs/images"), "/var/lib/vs/images");
  for (const char* out : {"/", "/srv", "/srv/parts2", "/srv/parts/../secret", "/srv/parts/..",
                          "/var/lib/vs/../x", "/mnt"}) {
    EXPECT_EQ(PicturePath(kFolders, out).error().code(), StatusCode::kInvalidArgument) << out;
  }
  EXPECT_EQ(PicturePath(kFolders, "/etc").error().message(),
            "\"/etc\" is outside the folders that this server reads pictures from; move them below "
            "its data folder, or let the server's configuration name a picture_root above them");
  EXPECT_EQ(DataPath(kFolders, "/srv/parts/rig.json").error().code(), StatusCode::kInvalidArgument);
  EXPECT_EQ(DataPath(kFolders, "/var/lib/vs/rig.json").error().code(),
            StatusCode::kInvalidArgument);
}

TEST(HostFolders, WithoutAServerEveryAbsolutePictureFolderIsFine) {
  EXPECT_EQ(PicturePath({}, "/home/me/pictures"), "/home/me/pictures");
  EXPECT_EQ(PicturePath({}, "/"), "/");
  EXPECT_EQ(PicturePath({}, "pictures").error().code(), StatusCode::kFailedPrecondition);
  EXPECT_THAT(DataPath({}, "rig.json").error().message(), HasSubstr("run this sequence on a"));
}

}  // namespace
}  // namespace vs
