#include "tests/server/vision/demo.h"

#include <filesystem>

#include "server/storage/atomic_file.h"

namespace vs::test {
namespace {

Status Copy(const std::filesystem::path& from, const std::filesystem::path& to) {
  VS_ASSIGN_OR_RETURN(const auto content, ReadFile(from, 1 << 20));
  return WriteFileAtomically(to, content);
}

}  // namespace

Status RestartAsDemo(TestServer* server) {
  const std::filesystem::path demo = VS_DEMO_DIR;
  const std::filesystem::path data = server->data_dir();
  VS_RETURN_IF_ERROR(Copy(demo / "rig.json", data / "rigs" / "demo.json"));
  VS_RETURN_IF_ERROR(Copy(demo / "stereo_depth.json", data / "sequences" / "stereo_depth.json"));
  server->Restart();
  return Status();
}

}  // namespace vs::test
