// Saves pictures and maps as PNG files and point clouds as PLY files, within limits.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <filesystem>
#include <optional>
#include <string_view>

#include "engine/base/str.h"
#include "engine/core/block.h"
#include "engine/image/picture_folder.h"
#include "engine/image/ply.h"
#include "engine/image/png.h"

namespace vs {
namespace {

constexpr int64_t kBytesPerMb = 1'000'000;

// "20261122T063041.661234Z": sorts by time, and no file system minds it.
std::string FileTime(int64_t utc_ns) {
  const std::time_t seconds = utc_ns / 1'000'000'000;
  std::tm utc{};
  gmtime_r(&seconds, &utc);
  char text[40];
  const size_t size = std::strftime(text, sizeof text, "%Y%m%dT%H%M%S", &utc);
  std::snprintf(text + size, sizeof text - size, ".%06dZ",
                static_cast<int>(utc_ns / 1000 % 1'000'000));
  return text;
}

// Relative, of names that are neither hidden nor special, as befits names that we make.
Status CheckFolder(const std::string& text) {
  const std::filesystem::path path(text);
  const bool plain = std::all_of(path.begin(), path.end(), [](const std::filesystem::path& part) {
    const std::string& name = part.native();
    return !name.empty() && name[0] != '.' &&
           name.find_first_not_of(
               "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ"
               "0123456789._-") == std::string::npos;
  });
  if (plain && !path.empty()) return Status();
  return InvalidArgument(
      Str("must be a path below the data folder, such as images/line1, not ", Quoted(text)));
}

// The usual convention of stereo data sets: disparity in 1/256 px, 0 where there is none.
Image<uint16_t> Disparity16(const DisparityMap& map, BufferPool& pool) {
  Image<uint16_t> image(pool, map.disparity.width(), map.disparity.height());
  const int offset = map.offset_px * 256;
  for (int y = 0; y < image.height(); ++y) {
    const uint16_t* from = map.disparity.Row(y);
    uint16_t* to = image.Row(y);
    for (int x = 0; x < image.width(); ++x) {
      const int value = from[x] * (256 / kDisparityScale) + offset;
      to[x] = from[x] == kInvalidDisparity ? 0 : std::clamp(value, 0, 65535);
    }
  }
  return image;
}

// Millimetres, 0 where unknown.
Image<uint16_t> Depth16(const DepthMap& map, BufferPool& pool) {
  Image<uint16_t> image(pool, map.depth_m.width(), map.depth_m.height());
  for (int y = 0; y < image.height(); ++y) {
    const float* from = map.depth_m.Row(y);
    uint16_t* to = image.Row(y);
    for (int x = 0; x < image.width(); ++x) {
      const float depth_mm = from[x] * 1000;
      to[x] = std::isnan(depth_mm) ? 0 : std::lround(std::clamp(depth_mm, 0.0F, 65535.0F));
    }
  }
  return image;
}

class SaveImages final : public Block {
 public:
  In<Value> picture{this, "picture",
                    "What to save: a frame, stereo frame, picture, disparity map, depth map or "
                    "point cloud."};
  In<bool> pass{this, "pass", "Whether the part is good, for the policy fail.", Need::kOptional};
  Out<std::string> path{this, "path",
                        "The first file of this frame, below the server's data folder."};
  Out<int64_t> saved{this, "saved", "Files saved since the sequence was started."};
  Param<std::string> folder{this,
                            "folder",
                            {.initial = "images",
                             .live = false,
                             .doc = "Folder below the server's data folder; it is made if it does "
                                    "not exist.",
                             .check = CheckFolder}};
  Param<std::string> policy{this,
                            "policy",
                            {.initial = "all",
                             .choices = {"all", "fail", "every_nth"},
                             .operator_editable = true,
                             .doc = "Which frames to save: all, those that did not pass, or every "
                                    "n-th."}};
  Param<int> every_nth{this,
                       "every_nth",
                       {.initial = 10,
                        .min = 1,
                        .max = 1'000'000,
                        .operator_editable = true,
                        .doc = "For the policy every_nth: 10 saves each tenth frame."}};
  Param<int> max_files{this,
                       "max_files",
                       {.initial = 1000,
                        .min = 1,
                        .max = 1'000'000,
                        .doc = "The folder holds at most so many pictures."}};
  Param<int> max_total_mb{this,
                          "max_total_mb",
                          {.initial = 1000,
                           .min = 1,
                           .max = 10'000'000,
                           .unit = "MB",
                           .doc = "The folder holds at most so much."}};
  Param<int> min_free_mb{this,
                         "min_free_mb",
                         {.initial = 1000,
                          .min = 0,
                          .max = 10'000'000,
                          .unit = "MB",
                          .doc = "Nothing is saved when the disk has less free space than this."}};
  Param<std::string> when_full{this,
                               "when_full",
                               {.initial = "stop",
                                .choices = {"stop", "delete_oldest"},
                                .doc = "What to do at a limit: stop saving, which shows as an "
                                       "error of this block, or delete the oldest pictures."}};

  Status CheckParams() const override {
    if (*policy != "fail" || pass.connected()) return Status();
    return Status(StatusCode::kInvalidArgument, "the policy needs an input",
                  {{"policy", "fail needs the input pass: connect it, or choose another policy"}});
  }

  Status Start() override {
    if (!CanSave(picture.source_type())) return WrongType(picture.source_type());
    VS_ASSIGN_OR_RETURN(const std::filesystem::path place,
                        DataPath(environment().folders, *folder));
    VS_ASSIGN_OR_RETURN(folder_, PictureFolder::Open(place));
    files_ = 0;
    runs_ = 0;
    return Status();
  }

  Status Run() override {
    ++runs_;
    if (*policy == "every_nth" && (runs_ - 1) % *every_nth != 0) return Status();
    // A part of which nothing is known is as interesting as a bad one.
    if (*policy == "fail" && pass.has_value() && *pass) return Status();
    return std::visit([this](const auto& held) { return Save(held); }, picture->variant());
  }

  void Stop() override { folder_.reset(); }

 private:
  static bool CanSave(std::string_view type) {
    return type == "frame" || type == "stereo_frame" || type == "grey_image" ||
           type == "color_image" || type == "disparity_map" || type == "depth_map" ||
           type == "point_cloud" || type == "any";
  }
  static Status WrongType(std::string_view type) {
    return InvalidArgument(
        Str("picture must be a frame, stereo_frame, grey_image, color_image, "
            "disparity_map, depth_map or point_cloud, not ",
            type));
  }

  Status Save(const std::shared_ptr<const Frame>& frame) { return Write(frame->image, "picture"); }
  Status Save(const std::shared_ptr<const GreyImage>& image) { return Write(*image, "picture"); }
  Status Save(const std::shared_ptr<const ColorImage>& image) { return Write(*image, "picture"); }
  Status Save(const std::shared_ptr<const StereoFrame>& pair) {
    if (pair->left == nullptr || pair->right == nullptr) {
      return InvalidArgument("a picture of the pair is missing");
    }
    VS_RETURN_IF_ERROR(Write(pair->left->image, "left"));
    return Write(pair->right->image, "right");
  }
  Status Save(const std::shared_ptr<const DisparityMap>& map) {
    if (map->offset_px < 0) {
      return InvalidArgument(
          Str("the file format holds no negative disparities, but the map begins "
              "at ",
              map->offset_px, " px: search from 0"));
    }
    return Write(Disparity16(*map, pool()), "disparity");
  }
  Status Save(const std::shared_ptr<const DepthMap>& map) {
    return Write(Depth16(*map, pool()), "depth");
  }
  Status Save(const std::shared_ptr<const PointCloud>& cloud) {
    return Write(EncodePly(*cloud), "points", ".ply");
  }
  template <class T>
  Status Save(const T&) {
    return WrongType(TypeName(*picture));
  }

  template <class Picture>
  Status Write(const Picture& image, const char* kind) {
    VS_ASSIGN_OR_RETURN(const std::vector<uint8_t> png, EncodePng(image));
    return Write(png, kind, ".png");
  }
  Status Write(const std::vector<uint8_t>& content, std::string_view kind, const char* extension) {
    char number[16];
    std::snprintf(number, sizeof number, "%08llu",
                  static_cast<unsigned long long>(frame().number % 100'000'000));
    const std::string name =
        Str(FileTime(environment().clock->UtcNs()), "_", number, "_", kind, extension);
    PictureFolder::Limits limits;
    limits.max_files = *max_files;
    limits.max_bytes = *max_total_mb * kBytesPerMb;
    limits.min_free_bytes = *min_free_mb * kBytesPerMb;
    limits.delete_oldest = *when_full == "delete_oldest";
    VS_RETURN_IF_ERROR(folder_->Write(name, content, limits));
    saved.Set(++files_);
    if (kind != "right") path.Set(Str(*folder, "/", name));
    return Status();
  }

  std::optional<PictureFolder> folder_;
  int64_t files_ = 0;
  int64_t runs_ = 0;
};

VS_REGISTER_BLOCK(SaveImages,
                  {.category = "Record",
                   .doc = "Saves pictures as PNG files: 8-bit for pictures, 16-bit for maps "
                          "(disparity in 1/256 px, depth in mm, 0 where there is none). Point "
                          "clouds become PLY files in metres."});

}  // namespace
}  // namespace vs
