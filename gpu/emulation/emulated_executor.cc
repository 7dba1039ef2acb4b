#include "gpu/emulation/emulated_executor.h"

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <memory>

#include "engine/stereo/path_cost.h"
#include "engine/stereo/refine.h"
#include "engine/stereo/selection.h"
#include "gpu/frame.h"
#include "gpu/stages.h"

namespace vs::gpu {
namespace {

constexpr int kPoison = 0xa5;
constexpr std::align_val_t kAlignment{256};

class EmulatedExecutor final : public Executor {
 public:
  explicit EmulatedExecutor(uint32_t seed) : launch_(seed) {}

  Status Prepare(const SgmSettings& settings, int width, int height) override {
    bytes_ = FrameMemory(settings, width, height, nullptr).Bytes();
    memory_.reset(static_cast<std::byte*>(::operator new(bytes_, kAlignment)));
    frame_ = FrameMemory(settings, width, height, memory_.get()).frame();
    return {};
  }

  Result<DisparityMap> Run(const GreyImage& left, const GreyImage& right,
                           BufferPool& pool) override {
    std::memset(memory_.get(), kPoison, bytes_);
    std::memset(frame_.counts, 0, sizeof *frame_.counts);
    const Penalties penalties = MakePenalties(frame_.settings);
    std::copy(penalties.p2.begin(), penalties.p2.end(), const_cast<uint8_t*>(frame_.p2));
    Upload(left, const_cast<uint8_t*>(frame_.input[kLeft]));
    Upload(right, const_cast<uint8_t*>(frame_.input[kRight]));
    const DeviceMap result = RunStages(launch_, frame_);
    DisparityMap map = MakeDisparityMap(frame_.width, frame_.height,
                                        DisparityOffset(frame_.settings), pool);
    Download(result.disparity, &map.disparity);
    Download(result.confidence, &map.confidence);
    Download(result.reason, &map.reason);
    return map;
  }

  size_t DeviceBytes() const override { return bytes_; }
  int64_t StagesNs() const override { return 0; }

 private:
  struct Free {
    void operator()(std::byte* memory) const { ::operator delete(memory, kAlignment); }
  };

  static void Upload(const GreyImage& picture, uint8_t* to) {
    for (int y = 0; y < picture.height(); ++y) {
      std::copy_n(picture.Row(y), picture.width(), to + static_cast<size_t>(y) * picture.width());
    }
  }
  template <class T>
  static void Download(const T* from, Image<T>* image) {
    for (int y = 0; y < image->height(); ++y) {
      std::copy_n(from + static_cast<size_t>(y) * image->width(), image->width(), image->Row(y));
    }
  }

  EmulatedLaunch launch_;
  Frame frame_;
  size_t bytes_ = 0;
  std::unique_ptr<std::byte, Free> memory_;
};

}  // namespace

std::unique_ptr<Executor> MakeEmulatedExecutor(uint32_t seed) {
  return std::make_unique<EmulatedExecutor>(seed);
}

}  // namespace vs::gpu
