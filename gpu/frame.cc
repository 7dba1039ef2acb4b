#include "gpu/frame.h"

#include <algorithm>
#include <type_traits>

#include "engine/stereo/path_cost.h"
#include "engine/stereo/selection.h"

namespace vs::gpu {
namespace {

constexpr size_t kAlignment = 256;

}  // namespace

template <class T>
void FrameMemory::Take(size_t count, T** to) {
  if (base_ != nullptr) *to = reinterpret_cast<T*>(base_ + used_);
  used_ += (count * sizeof(T) + kAlignment - 1) / kAlignment * kAlignment;
}

void FrameMemory::TakeMap(size_t pixels, DeviceMap* map) {
  Take(pixels, &map->disparity);
  Take(pixels, &map->confidence);
  Take(pixels, &map->reason);
}

FrameMemory::FrameMemory(const StereoPlan& plan, int raw_width, int raw_height, std::byte* base)
    : base_(base) {
  const SgmSettings& settings = plan.settings;
  const Rectification* how = plan.rectification.get();
  Frame& f = frame_;
  f.settings = settings;
  f.raw_width = raw_width;
  f.raw_height = raw_height;
  f.width = how != nullptr ? how->left.width : raw_width;
  f.height = how != nullptr ? how->left.height : raw_height;
  f.interpolation = how != nullptr ? how->interpolation : Interpolation::kLinear;
  f.depth_rule = DepthRuleOf(GeometryOf(plan, f.width, f.height), DisparityOffset(settings));
  f.pitch = (settings.num_disparities + 7) / 8 * 8;
  f.sum_count = settings.directions == 1  ? 1
                : settings.directions > 5 ? 4
                                          : (settings.directions + 1) / 2;
  const auto pixels = static_cast<size_t>(f.Pixels());
  const size_t volume = pixels * f.pitch;

  Take(256, &f.p2);
  for (int view : {kLeft, kRight}) {
    if (how == nullptr) break;
    if (how->left.positions.empty()) {
      Take(pixels, &f.sources[view]);
    } else {
      Take(pixels, &f.positions[view]);
    }
  }
  kept_ = used_;

  // Next to each other, so that one copy brings both up.
  const size_t raw_pixels = static_cast<size_t>(raw_width) * raw_height;
  for (int view : {kLeft, kRight}) Take(raw_pixels, &f.uploaded[view]);
  for (int view : {kLeft, kRight}) {
    if (how != nullptr && how->half_size) Take(raw_pixels / 4, &f.halved[view]);
    f.input[view] = f.uploaded[view];
  }
  if (how != nullptr) Take(pixels, &f.input[kRight]);
  Take(1, &f.counts);
  Take(1, &f.conditioning);
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
  // What goes down lies together, whichever map that is.
  TakeMap(pixels, &f.map[0]);
  if (plan.depth) Take(pixels, &f.depth_m);
  if (how != nullptr) Take(pixels, &f.input[kLeft]);
  TakeMap(pixels, &f.map[1]);
  Take(pixels, &f.label);
  Take(pixels, &f.region);
  Take(volume, &f.costs);
  const bool window = settings.window_width * settings.window_height > 1;
  if (window || settings.smooth_cost) Take(volume, &f.other_costs);
  for (int k = 0; k < f.sum_count; ++k) Take(volume, &f.sums[k]);
}

void FillKept(const StereoPlan& plan, const Frame& frame) {
  const auto copy = [](const auto& from, const auto* to) {
    using T = std::remove_const_t<std::remove_pointer_t<decltype(to)>>;
    std::copy(from.begin(), from.end(), const_cast<T*>(to));
  };
  copy(MakePenalties(plan.settings).p2, frame.p2);
  if (plan.rectification == nullptr) return;
  const RemapTable* const tables[] = {&plan.rectification->left, &plan.rectification->right};
  for (int view : {kLeft, kRight}) {
    copy(tables[view]->sources, frame.sources[view]);
    copy(tables[view]->positions, frame.positions[view]);
  }
}

}  // namespace vs::gpu
