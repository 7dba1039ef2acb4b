#include "gpu/devices.h"

#include <mutex>

#include "engine/base/clock.h"
#include "engine/base/str.h"
#include "gpu/cuda_executor.h"
#include "gpu/cuda_matcher.h"

namespace vs::gpu {
namespace {

constexpr int kSpeedRank = 200;

void Register(const std::string& name, int device) {
  static const SystemClock clock;
  StereoMatchers::Get().Add(name, kSpeedRank, [device]() -> Result<std::unique_ptr<StereoMatcher>> {
    if (!Devices().has_value()) return Devices().error();
    return MakeCudaMatcher({.make_executor = [](int k) { return MakeCudaExecutor(k, {}); },
                            .make_substitute = [] { return StereoMatchers::Get().Make("cpu"); },
                            .clock = &clock,
                            .board = &Board()},
                           device);
  });
}

}  // namespace

DeviceBoard& Board() {
  static DeviceBoard board(Devices().has_value() ? static_cast<int>(Devices()->size()) : 0);
  return board;
}

void RegisterMatchers() {
  static std::once_flag once;
  std::call_once(once, [] {
    Register("cuda", DeviceBoard::kAny);
    const size_t count = Devices().has_value() ? Devices()->size() : 0;
    for (size_t k = 0; k < count; ++k) Register(Str("cuda:", k), static_cast<int>(k));
  });
}

}  // namespace vs::gpu
