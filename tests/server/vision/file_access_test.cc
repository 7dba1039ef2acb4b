// Which files of its machine a server reads for an engineer, over the real API.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <string>

#include "engine/base/str.h"
#include "tests/engine/camera/picture_files.h"
#include "tests/server/vision/vision_fixture.h"

namespace vs::test {
namespace {

using ::testing::HasSubstr;

// The configuration, and with it the folder "allowed", lies beside the data folder.
class FileAccess : public VisionTest {
 protected:
  FileAccess() : VisionTest({.config = "picture_root: \"allowed\""}) {
    for (const char* folder : {"data/run7", "allowed/run8", "secret"}) {
      WriteGrey(Beside(folder) / "1_left.png", 1);
      WriteGrey(Beside(folder) / "1_right.png", 2);
    }
  }

  std::filesystem::path Beside(const std::string& name) const {
    return server_.data_dir().parent_path() / name;
  }

  // Stores and starts a sequence with one block that names a file.
  grpc::Status StartWith(const BlockSpec& block) {
    SequenceSpec spec;
    spec.id = Str("files_", ++sequence_);
    spec.blocks = {block};
    if (block.type == "RectifyPair") {
      spec.blocks.push_back({"source", "SimulatedStereo", {}});
      spec.connections = {{"source", "pair", block.id, "pair"}};
    }
    Create(spec);
    grpc::Status started = Start(spec.id);
    if (started.ok()) Stop(spec.id);
    return started;
  }
  grpc::Status FileSource(const std::string& folder) {
    return StartWith({"files", "FileSource", {{"folder", folder}}});
  }
  grpc::Status Camera(const std::string& folder) {
    return StartWith({"files", "Camera", {{"address", "file:" + folder}}});
  }
  grpc::Status StereoCamera(const std::string& folder) {
    return StartWith(
        {"files", "StereoCamera", {{"left", "file:" + folder}, {"right", "file:" + folder}}});
  }
  grpc::Status RectifyPair(const std::string& file) {
    return StartWith({"files", "RectifyPair", {{"rig_file", file}}});
  }

 private:
  int sequence_ = 0;
};

TEST_F(FileAccess, PicturesComeFromTheDataFolderOrAPictureRoot) {
  for (const std::string& folder :
       {std::string("run7"), Beside("data/run7").string(), Beside("allowed").string() + "/run8"}) {
    for (const grpc::Status& started : {FileSource(folder), Camera(folder), StereoCamera(folder)}) {
      EXPECT_TRUE(started.ok()) << folder << ": " << started.error_message();
    }
  }
}

TEST_F(FileAccess, NothingElseIsRead) {
  const std::string absolute = Beside("secret").string();
  for (const std::string& folder : {std::string("../secret"), std::string("run7/../../secret"),
                                    absolute, Beside("allowed").string() + "/../secret"}) {
    for (const grpc::Status& started : {FileSource(folder), Camera(folder), StereoCamera(folder),
                                        RectifyPair(folder + "/1_left.png")}) {
      EXPECT_EQ(started.error_code(), grpc::StatusCode::INVALID_ARGUMENT) << folder;
      EXPECT_THAT(started.error_message(), HasSubstr("files: ")) << "the block at fault";
    }
  }
  EXPECT_THAT(FileSource(absolute).error_message(), HasSubstr("a picture_root above them"));
  EXPECT_THAT(RectifyPair(absolute).error_message(),
              HasSubstr("leads out of the server's data folder"));
}

TEST(CamerasOfTheConfiguration, FollowTheSameRule) {
  EXPECT_THROW(TestServer({.config = "camera { id: \"left\" uri: \"file:/srv/run7\" }"}),
               std::runtime_error);
  TestServer server({.config = "camera { id: \"left\" uri: \"file:/srv/run7\" }\n"
                               "camera { id: \"right\" uri: \"file:run7\" }\n"
                               "picture_root: \"/srv\""});
}

}  // namespace
}  // namespace vs::test
