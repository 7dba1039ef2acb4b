#include "engine/camera/image_file.h"

#include <fnmatch.h>

#include <algorithm>
#include <cstring>
#include <limits>
#include <memory>
#include <utility>

#include <opencv2/imgcodecs.hpp>

#include "engine/base/str.h"

namespace vs {
namespace {

namespace fs = std::filesystem;

constexpr float kDisparityFileScale = 256;
constexpr size_t kMostFiles = 1'000'000;

Result<cv::Mat> Read(const fs::path& file, int flags) {
  std::error_code error;
  if (!fs::is_regular_file(file, error)) return NotFound(Str("there is no file ", file.string()));
  try {
    cv::Mat picture = cv::imread(file.string(), flags);
    if (!picture.empty()) return picture;
  } catch (const cv::Exception& exception) {
    return InvalidArgument(
        Str("file ", file.string(), " is not a readable picture: ", exception.err));
  }
  return InvalidArgument(Str("file ", file.string(), " is not a readable picture"));
}

// The matrix' own memory as an image.
template <class T>
Image<T> Adopt(cv::Mat matrix) {
  auto owner = std::make_shared<cv::Mat>(std::move(matrix));
  const Buffer buffer{reinterpret_cast<std::byte*>(owner->data),
                      owner->step[0] * static_cast<size_t>(owner->rows), Place::kHost, owner};
  return Image<T>(buffer, owner->cols, owner->rows, owner->step[0]);
}

bool InCountingOrder(const std::string& a, const std::string& b) {
  return strverscmp(a.c_str(), b.c_str()) < 0;
}

}  // namespace

Result<GreyImage> ReadGreyImage(const fs::path& file) {
  VS_ASSIGN_OR_RETURN(cv::Mat picture,
                      Read(file, cv::IMREAD_GRAYSCALE | cv::IMREAD_IGNORE_ORIENTATION));
  return Adopt<uint8_t>(std::move(picture));
}

Result<Image<float>> ReadDisparityFile(const fs::path& file) {
  VS_ASSIGN_OR_RETURN(const cv::Mat stored, Read(file, cv::IMREAD_UNCHANGED));
  if (stored.type() != CV_16UC1) {
    return InvalidArgument(Str("file ", file.string(),
                               " holds no disparity: it must be a grey PNG with 16 bits a pixel, "
                               "disparity in px = value / 256"));
  }
  cv::Mat disparity_px;
  stored.convertTo(disparity_px, CV_32F, 1 / kDisparityFileScale);
  disparity_px.setTo(std::numeric_limits<float>::quiet_NaN(), stored == 0);
  return Adopt<float>(std::move(disparity_px));
}

Result<std::vector<fs::path>> FindFiles(const fs::path& folder, const std::string& pattern) {
  std::error_code error;
  if (!fs::is_directory(folder, error)) {
    return NotFound(Str("there is no folder ", folder.string(), " on the server"));
  }
  std::vector<std::string> found;
  std::string example;
  const auto depth = static_cast<int>(std::ranges::count(pattern, '/'));
  fs::recursive_directory_iterator i(folder, fs::directory_options::skip_permission_denied, error);
  for (size_t seen = 0; !error && i != fs::recursive_directory_iterator() && seen < kMostFiles;
       i.increment(error), ++seen) {
    if (i.depth() >= depth) i.disable_recursion_pending();
    std::error_code ignored;
    if (!i->is_regular_file(ignored)) continue;
    const std::string name = fs::path(i->path()).lexically_relative(folder).string();
    if (fnmatch(pattern.c_str(), name.c_str(), FNM_PATHNAME | FNM_PERIOD) == 0) {
      found.push_back(name);
    } else if (example.empty()) {
      example = name;
    }
  }
  if (error) return NotFound(Str("folder ", folder.string(), " cannot be read: ", error.message()));
  if (found.empty()) {
    return NotFound(
        Str("no file in ", folder.string(), " matches \"", pattern, "\"",
            example.empty() ? "; the folder is empty" : Str("; there is, for example, ", example)));
  }
  std::ranges::sort(found, InCountingOrder);
  std::vector<fs::path> files;
  files.reserve(found.size());
  for (const std::string& name : found) files.push_back(folder / name);
  return files;
}

}  // namespace vs
