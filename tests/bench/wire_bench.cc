// What packing a disparity map for the network costs, on the map that the reference matcher makes
// of the simulated scene at 648 x 483.
#include <benchmark/benchmark.h>

#include <vector>

#include "engine/sim/ideal_stereo.h"
#include "engine/stereo/stereo_matcher.h"
#include "proto/wire/rvl.h"
#include "proto/wire/zstd.h"

namespace vs {
namespace {

using Pixels = std::vector<uint16_t>;

const Pixels& Disparity() {
  static const Pixels pixels = [] {
    BufferPool pool;
    const StereoFrame pair = sim::IdealStereo({}).Capture(0, 1, pool);
    const auto matcher = StereoMatchers::Get().Make("reference").value();
    const DisparityMap map =
        matcher->Match(pair.left->image, pair.right->image, {.num_disparities = 128}, 2, pool)
            .value();
    Pixels copy;
    for (int y = 0; y < map.disparity.height(); ++y) {
      copy.insert(copy.end(), map.disparity.Row(y), map.disparity.Row(y) + map.disparity.width());
    }
    return copy;
  }();
  return pixels;
}

std::vector<uint8_t> Rvl() {
  const Pixels& pixels = Disparity();
  std::vector<uint8_t> packed(wire::RvlBound(pixels.size()));
  packed.resize(wire::EncodeRvl(pixels.data(), pixels.size(), 1, pixels.size() * 2, packed));
  return packed;
}

void Report(benchmark::State& state, size_t packed_bytes) {
  state.counters["percent_of_raw"] =
      100.0 * static_cast<double>(packed_bytes) / (2.0 * static_cast<double>(Disparity().size()));
}

void EncodeRvl(benchmark::State& state) {
  const Pixels& pixels = Disparity();
  std::vector<uint8_t> packed(wire::RvlBound(pixels.size()));
  size_t size = 0;
  for (auto _ : state) {
    size = wire::EncodeRvl(pixels.data(), pixels.size(), 1, pixels.size() * 2, packed);
    benchmark::ClobberMemory();
  }
  Report(state, size);
}

void DecodeRvl(benchmark::State& state) {
  const std::vector<uint8_t> packed = Rvl();
  Pixels pixels(Disparity().size());
  for (auto _ : state) {
    if (wire::DecodeRvl(packed, pixels) != wire::DecodeError::kNone) state.SkipWithError("fault");
    benchmark::ClobberMemory();
  }
  Report(state, packed.size());
}

void PackZstd(benchmark::State& state) {
  const std::vector<uint8_t> rvl = Rvl();
  std::vector<uint8_t> packed(wire::ZstdPacker::Bound(rvl.size()));
  wire::ZstdPacker packer;
  size_t size = 0;
  for (auto _ : state) size = packer.Pack(rvl, packed);
  Report(state, size);
}

void UnpackZstd(benchmark::State& state) {
  const std::vector<uint8_t> rvl = Rvl();
  std::vector<uint8_t> packed(wire::ZstdPacker::Bound(rvl.size()));
  packed.resize(wire::ZstdPacker().Pack(rvl, packed));
  wire::ZstdUnpacker unpacker;
  std::vector<uint8_t> unpacked;
  for (auto _ : state) {
    if (unpacker.Unpack(packed, rvl.size(), &unpacked) != wire::DecodeError::kNone) {
      state.SkipWithError("fault");
    }
  }
  Report(state, packed.size());
}

BENCHMARK(EncodeRvl)->Unit(benchmark::kMillisecond);
BENCHMARK(DecodeRvl)->Unit(benchmark::kMillisecond);
BENCHMARK(PackZstd)->Unit(benchmark::kMillisecond);
BENCHMARK(UnpackZstd)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace vs

BENCHMARK_MAIN();
