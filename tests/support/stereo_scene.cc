#include "tests/support/stereo_scene.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>

#include <nlohmann/json.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "engine/base/str.h"
#include "engine/image/opencv_view.h"

namespace vs {
namespace {

Result<GreyImage> ReadGrey(const std::filesystem::path& path, BufferPool& pool) {
  const cv::Mat pixels = cv::imread(path.string(), cv::IMREAD_GRAYSCALE);
  if (pixels.empty()) return NotFound(Str(path.string(), " is missing or no picture"));
  GreyImage image(pool, pixels.cols, pixels.rows);
  pixels.copyTo(CvView(image));
  return image;
}

StereoTruth MakeTruth(const cv::Mat& stored, double scale, const cv::Mat& visible,
                      BufferPool& pool) {
  StereoTruth truth{.disparity_px = Image<float>(pool, stored.cols, stored.rows),
                    .visible = GreyImage(pool, stored.cols, stored.rows)};
  stored.convertTo(CvView(truth.disparity_px), CV_32F, scale);
  CvView(truth.disparity_px).setTo(std::nanf(""), stored == 0);
  visible.copyTo(CvView(truth.visible));
  return truth;
}

// Where the truth is nearer than all else that falls on the same right pixel.
cv::Mat VisibleByDepth(const cv::Mat& disparity) {
  cv::Mat visible(disparity.size(), CV_8U, cv::Scalar(0));
  std::vector<float> nearest(static_cast<size_t>(disparity.cols));
  for (int y = 0; y < disparity.rows; ++y) {
    const auto* row = disparity.ptr<float>(y);
    std::fill(nearest.begin(), nearest.end(), 0.0F);
    for (int x = 0; x < disparity.cols; ++x) {
      const long counterpart = std::lround(static_cast<float>(x) - row[x]);
      if (row[x] > 0 && counterpart >= 0) {
        nearest[counterpart] = std::max(nearest[counterpart], row[x]);
      }
    }
    for (int x = 0; x < disparity.cols; ++x) {
      const long counterpart = std::lround(static_cast<float>(x) - row[x]);
      if (row[x] > 0 && counterpart >= 0 && row[x] >= nearest[counterpart] - 1) {
        visible.at<uint8_t>(y, x) = 255;
      }
    }
  }
  return visible;
}

}  // namespace

Result<StereoScene> LoadStereoScene(const std::filesystem::path& folder, BufferPool& pool) {
  StereoScene scene;
  VS_ASSIGN_OR_RETURN(scene.left, ReadGrey(folder / "left.png", pool));
  VS_ASSIGN_OR_RETURN(scene.right, ReadGrey(folder / "right.png", pool));
  const cv::Mat disparity = cv::imread((folder / "disp.png").string(), cv::IMREAD_UNCHANGED);
  const cv::Mat visible = cv::imread((folder / "nonocc.png").string(), cv::IMREAD_GRAYSCALE);
  std::ifstream meta_file(folder / "meta.json");
  const auto meta = nlohmann::json::parse(meta_file, nullptr, false);
  if (disparity.type() != CV_16U || visible.size() != disparity.size() || meta.is_discarded()) {
    return InvalidArgument(Str(folder.string(), ": disp.png, nonocc.png or meta.json is unusable"));
  }
  scene.truth = MakeTruth(disparity, 1.0 / 256, visible, pool);
  scene.name = meta.value("name", folder.filename().string());
  scene.num_disparities = meta.value("num_disparities", 0);
  return scene;
}

std::vector<std::filesystem::path> StereoSceneFoldersIn(const std::filesystem::path& folder) {
  std::vector<std::filesystem::path> folders;
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator(folder, error)) {
    if (std::filesystem::exists(entry.path() / "meta.json")) folders.push_back(entry.path());
  }
  std::sort(folders.begin(), folders.end());
  return folders;
}

std::vector<std::filesystem::path> StereoSceneFolders() {
  const char* root = std::getenv("VS_TEST_DATA");
  if (root == nullptr) return {};
  return StereoSceneFoldersIn(std::filesystem::path(root) / "stereo");
}

Status WriteStereoScene(const StereoScene& scene, const std::filesystem::path& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  cv::Mat disparity;
  cv::Mat truth = CvView(scene.truth.disparity_px).clone();
  truth.setTo(0, truth != truth);  // unknown is not a number
  truth.convertTo(disparity, CV_16U, 256);
  const bool written = cv::imwrite((folder / "left.png").string(), CvView(scene.left)) &&
                       cv::imwrite((folder / "right.png").string(), CvView(scene.right)) &&
                       cv::imwrite((folder / "disp.png").string(), disparity) &&
                       cv::imwrite((folder / "nonocc.png").string(), CvView(scene.truth.visible));
  std::ofstream meta(folder / "meta.json");
  meta << nlohmann::json{{"name", scene.name}, {"num_disparities", scene.num_disparities}};
  if (!written || !meta.good()) return Unavailable(Str("cannot write to ", folder.string()));
  return Status();
}

Result<StereoScene> LoadAloe(BufferPool& pool) {
  const std::filesystem::path folder = "/usr/share/doc/opencv-doc/examples/data";
  StereoScene scene;
  scene.name = "aloe_half";
  scene.num_disparities = 128;
  const cv::Mat truth = cv::imread((folder / "aloeGT.png").string(), cv::IMREAD_GRAYSCALE);
  const cv::Mat views[2] = {cv::imread((folder / "aloeL.jpg").string(), cv::IMREAD_GRAYSCALE),
                            cv::imread((folder / "aloeR.jpg").string(), cv::IMREAD_GRAYSCALE)};
  if (truth.empty() || views[0].empty() || views[1].empty()) {
    return NotFound(Str(folder.string(), " has no aloe pair; install the package opencv-doc"));
  }
  const cv::Size size(views[0].cols / 2, views[0].rows / 2);
  GreyImage* const images[2] = {&scene.left, &scene.right};
  for (int k = 0; k < 2; ++k) {
    *images[k] = GreyImage(pool, size.width, size.height);
    cv::resize(views[k], CvView(*images[k]), size, 0, 0, cv::INTER_AREA);
  }
  cv::Mat disparity;
  cv::resize(truth, disparity, size, 0, 0, cv::INTER_NEAREST);
  cv::Mat disparity_px;
  disparity.convertTo(disparity_px, CV_32F, 0.5);
  scene.truth = MakeTruth(disparity, 0.5, VisibleByDepth(disparity_px), pool);
  return scene;
}

}  // namespace vs
