#include "gpu/emulation/emulated_executor.h"

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <memory>

#include "gpu/download.h"
#include "gpu/frame.h"
#include "gpu/stages.h"

namespace vs::gpu {
namespace {

constexpr int kPoison = 0xa5;
constexpr std::align_val_t kAlignment{256};

class EmulatedExecutor final : public Executor {
 public:
  explicit EmulatedExecutor(uint32_t seed) : launch_(seed) {}

  Status Prepare(const StereoPlan& plan, int width, int height) override {
    plan_ = plan;
    const FrameMemory needed(plan, width, height, nullptr);
    bytes_ = needed.Bytes();
    kept_bytes_ = needed.KeptBytes();
    memory_.reset(static_cast<std::byte*>(::operator new(bytes_, kAlignment)));
    frame_ = FrameMemory(plan, width, height, memory_.get()).frame();
    FillKept(plan, frame_);
    return {};
  }

  Result<StereoResult> Run(const GreyImage& left, const GreyImage& right,
                           BufferPool& pool) override {
    std::memset(memory_.get() + kept_bytes_, kPoison, bytes_ - kept_bytes_);
    std::memset(frame_.counts, 0, sizeof *frame_.counts);
    Upload(left, frame_.uploaded[kLeft]);
    Upload(right, frame_.uploaded[kRight]);
    const DeviceMap map = RunStages(launch_, frame_);
    const Download download = DownloadOf(frame_, map);
    const Buffer bytes = pool.Acquire(download.size_bytes);
    std::memcpy(bytes.data, download.begin, download.size_bytes);
    return ResultIn(bytes, plan_, frame_, map, left);
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
  EmulatedLaunch launch_;
  StereoPlan plan_;
  Frame frame_;
  size_t bytes_ = 0;
  size_t kept_bytes_ = 0;
  std::unique_ptr<std::byte, Free> memory_;
};

}  // namespace

std::unique_ptr<Executor> MakeEmulatedExecutor(uint32_t seed) {
  return std::make_unique<EmulatedExecutor>(seed);
}

}  // namespace vs::gpu
