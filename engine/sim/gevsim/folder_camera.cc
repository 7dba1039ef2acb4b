#include "engine/sim/gevsim/folder_camera.h"

#include <fnmatch.h>

#include <algorithm>
#include <filesystem>

#include <opencv2/imgcodecs.hpp>

#include "engine/base/str.h"

namespace vs::sim {
namespace {

// OpenCV throws on some broken files and gives an empty matrix for others.
cv::Mat ReadGrey(const std::string& file) {
  try {
    return cv::imread(file, cv::IMREAD_GRAYSCALE);
  } catch (const cv::Exception&) {
    return {};
  }
}

}  // namespace

std::vector<std::string> ListPictures(const std::string& folder, const std::string& pattern) {
  std::vector<std::string> files;
  std::error_code ignored;  // an unreadable folder has no pictures
  for (const auto& entry : std::filesystem::directory_iterator(folder, ignored)) {
    const std::string name = entry.path().filename();
    if (fnmatch(pattern.c_str(), name.c_str(), 0) == 0) files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  return files;
}

Result<std::unique_ptr<FolderCamera>> FolderCamera::Load(const std::vector<std::string>& files,
                                                         int64_t period_ns,
                                                         const SensorNoise& noise) {
  std::unique_ptr<FolderCamera> camera;
  for (const std::string& file : files) {
    const cv::Mat picture = ReadGrey(file);
    if (picture.empty()) return InvalidArgument(Str(file, " is not a picture that can be read"));
    if (camera == nullptr) {
      camera.reset(new FolderCamera(picture.cols, picture.rows, period_ns, noise));
    }
    if (picture.cols != camera->width() || picture.rows != camera->height()) {
      return InvalidArgument(Str(file, " is ", picture.cols, " x ", picture.rows, " pixels, but ",
                                 files.front(), " is ", camera->width(), " x ", camera->height(),
                                 "; all pictures must have one size"));
    }
    auto& pixels = camera->pictures_.emplace_back();
    for (int y = 0; y < picture.rows; ++y) {
      pixels.insert(pixels.end(), picture.ptr(y), picture.ptr(y) + picture.cols);
    }
  }
  if (camera == nullptr) return NotFound("there are no pictures to show");
  return camera;
}

FolderCamera::FolderCamera(int width, int height, int64_t period_ns, const SensorNoise& noise)
    : PictureSource(width, height, 1.0, noise), period_ns_(period_ns) {}

void FolderCamera::Look(int64_t instant_ns) {
  // Pulses of the line come at whole periods; rounding forgives a camera clock its last tick.
  const int64_t number = (instant_ns + period_ns_ / 2) / period_ns_;
  shown_ = static_cast<size_t>(number) % pictures_.size();
}

const Light* FolderCamera::LightRows(int y, int count) {
  const size_t pixels = static_cast<size_t>(count) * width();
  const uint8_t* grey = &pictures_[shown_][static_cast<size_t>(y) * width()];
  rows_.resize(pixels);
  std::transform(grey, grey + pixels, rows_.begin(),
                 [](uint8_t level) { return static_cast<Light>(level * kLightPerGrey); });
  return rows_.data();
}

}  // namespace vs::sim
