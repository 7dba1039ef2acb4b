// The driver "file": plays the pictures of a folder as one camera.
#include <filesystem>
#include <memory>
#include <utility>
#include <vector>

#include "engine/base/clock.h"
#include "engine/base/mutex.h"
#include "engine/base/str.h"
#include "engine/camera/camera_source.h"
#include "engine/camera/image_file.h"
#include "engine/camera/player.h"

namespace vs {
namespace {

namespace fs = std::filesystem;

// Opens pictures one after the other and keeps count of those that cannot be read.
class FileCamera final : public CameraSource {
 public:
  FileCamera(fs::path folder, std::string pattern, PlayOptions play)
      : folder_(std::move(folder)), pattern_(std::move(pattern)), play_(play) {}
  ~FileCamera() override { player_.Stop(); }

  Status Start(FrameSink sink) override {
    if (player_.Playing()) return FailedPrecondition("this folder is already being played");
    VS_ASSIGN_OR_RETURN(files_, FindFiles(folder_, pattern_));
    VS_RETURN_IF_ERROR(CheckReadable());
    unreadable_in_a_row_ = 0;
    player_.Start(files_.size(), play_,
                  [this, sink = std::move(sink)](size_t index, uint64_t number) {
                    FramePtr frame = Read(index, number);
                    const bool readable = frame != nullptr;
                    if (readable) sink(std::move(frame));
                    return GoOn(readable);
                  });
    return {};
  }
  void Stop() override { player_.Stop(); }

  Status Trigger() override {
    return FailedPrecondition("a folder of pictures has no trigger; give it a rate with fps=N");
  }
  Result<std::vector<FeatureInfo>> Features() override { return std::vector<FeatureInfo>(); }
  Result<FeatureValue> GetFeature(const std::string& name) override { return NoFeature(name); }
  Result<FeatureValue> SetFeature(const std::string& name, const FeatureValue& /*value*/) override {
    return NoFeature(name);
  }

  CameraStats Stats() const override {
    MutexLock lock(mutex_);
    CameraStats stats = stats_;
    stats.state = player_.Playing() ? CameraState::kStreaming : CameraState::kIdle;
    stats.model = "Folder " + folder_.string();
    return stats;
  }
  bool Recorded() const override { return true; }

 private:
  static Status NoFeature(const std::string& name) {
    return NotFound(Str("a folder of pictures has no feature \"", name, "\""));
  }

  // One readable picture is enough to begin with.
  Status CheckReadable() const {
    Status first;
    for (const fs::path& file : files_) {
      const auto picture = ReadGreyImage(file);
      if (picture) return {};
      if (first.ok()) first = picture.error();
    }
    return InvalidArgument(Str("none of the ", files_.size(), " files in ", folder_.string(),
                               " that match \"", pattern_, "\" can be used: ", first.message()));
  }

  FramePtr Read(size_t index, uint64_t number) {
    auto picture = ReadGreyImage(files_[index]);
    MutexLock lock(mutex_);
    if (!picture) {
      ++stats_.incomplete;
      stats_.last_error = picture.error().message() + "; skipped";
      return nullptr;
    }
    ++stats_.frames;
    auto frame = std::make_shared<Frame>();
    frame->image = std::move(*picture);
    frame->camera = folder_.string();
    frame->number = number;
    frame->trigger = number;
    frame->timestamp_ns = clock_.MonotonicNs();
    frame->capture_ns = frame->timestamp_ns;
    frame->arrival_ns = frame->timestamp_ns;
    return frame;
  }

  // False after a whole round without a readable picture, which would else go on for ever.
  bool GoOn(bool readable) {
    unreadable_in_a_row_ = readable ? 0 : unreadable_in_a_row_ + 1;
    if (unreadable_in_a_row_ < files_.size()) return true;
    MutexLock lock(mutex_);
    stats_.last_error += "; ended, for no picture can be read any more";
    return false;
  }

  const fs::path folder_;
  const std::string pattern_;
  const PlayOptions play_;
  const SystemClock clock_;
  std::vector<fs::path> files_;
  size_t unreadable_in_a_row_ = 0;
  mutable Mutex mutex_;
  CameraStats stats_ VS_GUARDED_BY(mutex_);
  Player player_;
};

Result<std::unique_ptr<CameraSource>> MakeFileCamera(const CameraUri& uri) {
  UriOptions options(uri);
  const std::string pattern = options.Text("pattern", "*");
  PlayOptions play;
  play.fps = options.Number("fps", 0, 0, 1000);
  play.loop = options.Flag("loop", false);
  VS_RETURN_IF_ERROR(options.Check());
  return std::unique_ptr<CameraSource>(
      std::make_unique<FileCamera>(fs::path(uri.address), pattern, play));
}

VS_REGISTER_CAMERA("file", MakeFileCamera);

}  // namespace
}  // namespace vs
