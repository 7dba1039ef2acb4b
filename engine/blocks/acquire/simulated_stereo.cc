// Rectified pairs of the simulated scene, with their truth.
#include <memory>
#include <optional>
#include <utility>

#include "engine/base/mailbox.h"
#include "engine/base/recycler.h"
#include "engine/camera/player.h"
#include "engine/core/block.h"
#include "engine/sim/ideal_stereo.h"

namespace vs {
namespace {

constexpr double kUnpacedHz = 30;  // simulated time between two pairs when they are not paced

class SimulatedStereo final : public Block {
 public:
  Out<StereoFrame> pair{this, "pair",
                        "A rectified pair of the simulated scene, with its true disparity."};
  Param<double> rate_hz{this,
                        "rate_hz",
                        {.initial = 30,
                         .min = 0.0,
                         .max = 1000.0,
                         .unit = "Hz",
                         .live = false,
                         .doc = "Pairs a second; 0 gives the next pair whenever the sequence is "
                                "ready, as if 1/30 s had passed."}};
  Param<int> binning{
      this,
      "binning",
      {.initial = 2,
       .min = 1,
       .max = 2,
       .live = false,
       .doc = "How many pixels of the sensor are joined, in both directions: 1 gives "
              "pictures of 1296 x 966 pixels, 2 of 648 x 483."}};
  Param<double> noise{this,
                      "noise",
                      {.initial = 1,
                       .min = 0.0,
                       .max = 10.0,
                       .live = false,
                       .doc = "Noise of the pictures: 0 is none, 1 that of a real camera."}};
  Param<int> seed{this,
                  "seed",
                  {.initial = 1,
                   .min = 0,
                   .max = 1000000,
                   .live = false,
                   .doc = "Chooses the noise: the same seed gives the same pictures again."}};

  SimulatedStereo() {
    due_.OnAvailable([this] { Wake(); });
  }

  Status Start() override {
    scene_.emplace(sim::IdealStereoSettings{
        .binning = *binning, .noise = *noise, .seed = static_cast<uint64_t>(*seed)});
    unpaced_number_ = 0;
    due_.Reopen(Mailbox<uint64_t>::Policy::kLatest);
    if (*rate_hz > 0) {
      clock_.Start(1, {.fps = *rate_hz, .loop = true},
                   [this](size_t /*index*/, uint64_t number) { return due_.Put(number); });
    }
    return {};
  }

  bool Ready() override { return *rate_hz == 0 || due_.Available(); }

  Status Run() override {
    const auto number = *rate_hz == 0 ? std::optional(++unpaced_number_) : due_.TryTake();
    if (!number) return {};
    const double simulated_s =
        static_cast<double>(*number - 1) / (*rate_hz == 0 ? kUnpacedHz : *rate_hz);
    const int64_t now_ns = environment().clock->MonotonicNs();
    StereoFrame taken = scene_->Capture(static_cast<int64_t>(simulated_s * 1e9), *number, pool());
    taken.left = OnHostClock(*taken.left, now_ns);
    taken.right = OnHostClock(*taken.right, now_ns);
    frame().source_number = *number;
    frame().capture_ns = now_ns;
    frame().arrival_ns = taken.left->arrival_ns;
    pair.Set(std::move(taken));
    return {};
  }

  void Stop() override {
    due_.Close();
    clock_.Stop();
  }

  uint64_t Dropped() const override { return due_.Dropped(); }

 private:
  // The scene has a time of its own; latency is measured on the host's.
  FramePtr OnHostClock(Frame view, int64_t capture_ns) {
    view.capture_ns = capture_ns;
    view.arrival_ns = environment().clock->MonotonicNs();
    return std::allocate_shared<Frame>(frame_memory_, std::move(view));
  }

  std::optional<sim::IdealStereo> scene_;
  Player clock_;
  Mailbox<uint64_t> due_;  // number of the pair whose time has come
  uint64_t unpaced_number_ = 0;
  Recycler<Frame> frame_memory_;
};

VS_REGISTER_BLOCK(SimulatedStereo,
                  {.category = "Acquire",
                   .doc = "Gives rectified pairs of a simulated scene with a moving part, together "
                          "with the truth, to try and measure what follows without cameras."});

}  // namespace
}  // namespace vs
