#include "engine/camera/file_pair_source.h"

#include <utility>
#include <vector>

#include "engine/base/clock.h"
#include "engine/base/mutex.h"
#include "engine/base/str.h"
#include "engine/camera/file_pairs.h"
#include "engine/camera/image_file.h"

namespace vs {
namespace {

namespace fs = std::filesystem;

FramePtr MakeFrame(GreyImage image, const fs::path& file, uint64_t number, int64_t now_ns) {
  auto frame = std::make_shared<Frame>();
  frame->image = std::move(image);
  frame->camera = file.parent_path().string();
  frame->number = number;
  frame->trigger = number;
  frame->timestamp_ns = now_ns;
  frame->capture_ns = now_ns;
  frame->arrival_ns = now_ns;
  return frame;
}

class FilePairSource final : public StereoSource {
 public:
  explicit FilePairSource(FilePairOptions options) : options_(std::move(options)) {}
  ~FilePairSource() override { player_.Stop(); }

  Status Start(StereoSink sink) override {
    if (player_.Playing()) return FailedPrecondition("this folder is already being played");
    VS_ASSIGN_OR_RETURN(pairs_, FindFilePairs(options_));
    VS_RETURN_IF_ERROR(CheckReadable());
    unusable_in_a_row_ = 0;
    player_.Start(pairs_.size(), options_.play,
                  [this, sink = std::move(sink)](size_t index, uint64_t number) {
                    auto pair = Read(pairs_[index], number);
                    if (pair) sink(std::make_shared<StereoFrame>(std::move(*pair)));
                    return GoOn(pair.has_value());
                  });
    return {};
  }
  void Stop() override { player_.Stop(); }

  StereoStats Stats() const override {
    const CameraState state = player_.Playing() ? CameraState::kStreaming : CameraState::kIdle;
    MutexLock lock(mutex_);
    StereoStats stats = stats_;
    stats.left.state = state;
    stats.right.state = state;
    return stats;
  }
  bool Recorded() const override { return true; }

 private:
  // One good pair is enough to begin with.
  Status CheckReadable() {
    for (const FilePair& pair : pairs_) {
      if (Read(pair, 0)) {
        MutexLock lock(mutex_);
        stats_ = StereoStats();
        return {};
      }
    }
    MutexLock lock(mutex_);
    const std::string& problem =
        stats_.left.last_error.empty() ? stats_.right.last_error : stats_.left.last_error;
    return InvalidArgument(Str("none of the ", pairs_.size(), " pairs in ",
                               options_.folder.string(), " can be used: ", problem));
  }

  std::optional<StereoFrame> Read(const FilePair& files, uint64_t number) {
    auto left = ReadGreyImage(files.left);
    if (!left) return Skip(&StereoStats::left, left.error().message());
    auto right = ReadGreyImage(files.right);
    if (!right) return Skip(&StereoStats::right, right.error().message());
    if (!left->SameSizeAs(*right)) {
      return Skip(&StereoStats::right,
                  Str(files.right.string(), " is ", right->width(), " x ", right->height(),
                      " pixels but its partner ", left->width(), " x ", left->height()));
    }
    StereoFrame pair;
    pair.number = number;
    pair.geometry = GeometryFor(left->width(), left->height());
    auto truth = ReadTruth(files, *left);
    if (!truth) return Skip(&StereoStats::left, truth.error().message());
    pair.truth = std::move(*truth);
    const int64_t now_ns = clock_.MonotonicNs();
    pair.left = MakeFrame(std::move(*left), files.left, number, now_ns);
    pair.right = MakeFrame(std::move(*right), files.right, number, now_ns);
    MutexLock lock(mutex_);
    ++stats_.left.frames;
    ++stats_.right.frames;
    ++stats_.pairing.pairs;
    stats_.pairing.by_trigger = true;
    return pair;
  }

  std::optional<RectifiedGeometry> GeometryFor(int width, int height) const {
    if (!options_.geometry) return std::nullopt;
    RectifiedGeometry geometry = *options_.geometry;
    if (geometry.width != 0) return Scaled(geometry, width, height);
    geometry.width = width;
    geometry.height = height;
    return geometry;
  }

  // Null when there is none.
  static Result<std::shared_ptr<const StereoTruth>> ReadTruth(const FilePair& files,
                                                              const GreyImage& left) {
    if (files.truth.empty()) return std::shared_ptr<const StereoTruth>();
    auto truth = std::make_shared<StereoTruth>();
    VS_ASSIGN_OR_RETURN(truth->disparity_px, ReadDisparityFile(files.truth));
    if (!files.visible.empty()) {
      VS_ASSIGN_OR_RETURN(truth->visible, ReadGreyImage(files.visible));
    } else {
      BufferPool pool;
      truth->visible = GreyImage(pool, left.width(), left.height());
      truth->visible.Fill(255);
    }
    if (!truth->disparity_px.SameSizeAs(left) || !truth->visible.SameSizeAs(left)) {
      return InvalidArgument(
          Str("the truth of ", files.left.string(), " has another size than the picture"));
    }
    return std::shared_ptr<const StereoTruth>(std::move(truth));
  }

  std::nullopt_t Skip(CameraStats StereoStats::*side, const std::string& problem) {
    MutexLock lock(mutex_);
    ++(stats_.*side).incomplete;
    (stats_.*side).last_error = problem + "; the pair was left out";
    return std::nullopt;
  }

  // False after a whole round without a usable pair, which would else go on for ever.
  bool GoOn(bool usable) {
    unusable_in_a_row_ = usable ? 0 : unusable_in_a_row_ + 1;
    if (unusable_in_a_row_ < pairs_.size()) return true;
    MutexLock lock(mutex_);
    for (CameraStats* side : {&stats_.left, &stats_.right}) {
      if (!side->last_error.empty()) {
        side->last_error += "; ended, for no pair can be used any more";
      }
    }
    return false;
  }

  const FilePairOptions options_;
  const SystemClock clock_;
  std::vector<FilePair> pairs_;
  size_t unusable_in_a_row_ = 0;
  mutable Mutex mutex_;
  StereoStats stats_ VS_GUARDED_BY(mutex_);
  Player player_;
};

}  // namespace

std::unique_ptr<StereoSource> MakeFilePairSource(FilePairOptions options) {
  return std::make_unique<FilePairSource>(std::move(options));
}

}  // namespace vs
