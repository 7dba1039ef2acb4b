#include "gpu/frame.h"

namespace vs::gpu {
namespace {

constexpr size_t kAlignment = 256;

}  // namespace

template <class T>
void FrameMemory::Take(size_t count, T** to) {
  if (base_ != nullptr) *to = reinterpret_cast<T*>(base_ + used_);
  used_ += (count * sizeof(T) + kAlignment - 1) / kAlignment * kAlignment;
}

FrameMemory::FrameMemory(const SgmSettings& settings, int width, int height, std::byte* base)
    : base_(base) {
  Frame& f = frame_;
  f.settings = settings;
  f.width = width;
  f.height = height;
  f.pitch = (settings.num_disparities + 7) / 8 * 8;
  f.sum_count = settings.directions == 1  ? 1
                : settings.directions > 5 ? 4
                                          : (settings.directions + 1) / 2;
  const auto pixels = static_cast<size_t>(f.Pixels());
  const size_t volume = pixels * f.pitch;
  Take(1, &f.counts);
  Take(1, &f.conditioning);
  // What comes from the host lies together, so that one copy brings it; so does a map.
  for (int view : {kLeft, kRight}) Take(pixels, &f.input[view]);
  Take(256, &f.p2);
  for (int view : {kLeft, kRight}) {
    Take(pixels, &f.across[view]);
    Take(pixels, &f.grey[view]);
    Take(pixels, &f.code[view]);
    Take(pixels, &f.code_high[view]);
    Take(pixels, &f.coarse[view]);
  }
  for (uint8_t** plane : {&f.winner_index, &f.winner_best, &f.winner_second, &f.winner_before,
                          &f.winner_after, &f.right_index}) {
    Take(pixels, plane);
  }
  for (DeviceMap& map : f.map) {
    Take(pixels, &map.disparity);
    Take(pixels, &map.confidence);
    Take(pixels, &map.reason);
  }
  Take(pixels, &f.label);
  Take(pixels, &f.region);
  Take(volume, &f.costs);
  const bool window = settings.window_width * settings.window_height > 1;
  if (window || settings.smooth_cost) Take(volume, &f.other_costs);
  for (int k = 0; k < f.sum_count; ++k) Take(volume, &f.sums[k]);
}

}  // namespace vs::gpu
