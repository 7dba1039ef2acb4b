// e2e_scene_truth FOLDER [BINNING]: one pair of the simulated scene, with what a perfect matcher would
// find; 648 x 483 pixels with a binning of 2, the default.
//
// Writes left.pgm and right.pgm (rectified, as the block FileSource reads them, and read in no time:
// what is measured with them is not the unpacking of files), disparity.f32 (the
// true disparity of each pixel, float32 in the machine's order, NaN where only one camera sees the
// point), and prints the geometry as JSON. A scene that stands still: whoever looks at the page
// sees the same pixels in every frame, so no test needs to know which frame is on the screen.
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <limits>
#include <string>
#include <vector>

#include "engine/base/status.h"
#include "engine/base/str.h"
#include "engine/sim/ideal_stereo.h"

namespace vs {
namespace {

// The part is in the middle of its way, well inside both pictures.
constexpr int64_t kInstantNs = 2'000'000'000;

Status WriteFile(const std::filesystem::path& file, const void* bytes, size_t size) {
  std::ofstream out(file, std::ios::binary);
  out.write(static_cast<const char*>(bytes), static_cast<std::streamsize>(size));
  out.close();
  return out ? Status() : Unavailable("cannot write " + file.string());
}

Status WritePgm(const std::filesystem::path& file, const GreyImage& image) {
  std::string bytes = Str("P5\n", image.width(), " ", image.height(), "\n255\n");
  for (int y = 0; y < image.height(); ++y) {
    bytes.append(reinterpret_cast<const char*>(image.Row(y)), static_cast<size_t>(image.width()));
  }
  return WriteFile(file, bytes.data(), bytes.size());
}

Status WriteScene(const std::filesystem::path& folder, int binning) {
  BufferPool pool;
  sim::IdealStereo scene({.binning = binning, .noise = 1, .seed = 1});
  const StereoFrame pair = scene.Capture(kInstantNs, 1, pool);
  VS_RETURN_IF_ERROR(WritePgm(folder / "left.pgm", pair.left->image));
  VS_RETURN_IF_ERROR(WritePgm(folder / "right.pgm", pair.right->image));
  const StereoTruth& truth = *pair.truth;
  std::vector<float> disparity_px;
  for (int y = 0; y < truth.disparity_px.height(); ++y) {
    for (int x = 0; x < truth.disparity_px.width(); ++x) {
      const bool seen = truth.visible.Row(y)[x] != 0;
      disparity_px.push_back(seen ? static_cast<float>(truth.disparity_px.Row(y)[x])
                                  : std::numeric_limits<float>::quiet_NaN());
    }
  }
  VS_RETURN_IF_ERROR(WriteFile(folder / "disparity.f32", disparity_px.data(),
                               disparity_px.size() * sizeof(float)));
  const RectifiedGeometry& geometry = *pair.geometry;
  std::printf(
      "{\"width\": %d, \"height\": %d, \"focal_px\": %.17g, \"baseline_m\": %.17g, "
      "\"center_x_px\": %.17g, \"center_y_px\": %.17g, \"offset_px\": %.17g}\n",
      geometry.width, geometry.height, geometry.focal_px, geometry.baseline_m, geometry.cx_px,
      geometry.cy_px, geometry.principal_offset_px);
  return Status();
}

}  // namespace
}  // namespace vs

int main(int argument_count, char** arguments) {
  const int binning = argument_count > 2 ? std::atoi(arguments[2]) : 2;
  if (argument_count < 2 || argument_count > 3 || binning < 1 || binning > 3) {
    std::fprintf(stderr, "usage: e2e_scene_truth FOLDER [BINNING (1, 2 or 3)]\n");
    return 2;
  }
  const vs::Status status = vs::WriteScene(arguments[1], binning);
  if (!status.ok()) std::fprintf(stderr, "e2e_scene_truth: %s\n", status.ToString().c_str());
  return status.ok() ? 0 : 1;
}
