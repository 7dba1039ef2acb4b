// The emulation that other tests of kernels stand on: what the words of simt.h mean.
#include "gpu/kernels/simt.h"

#include <gtest/gtest.h>

#include <numeric>
#include <vector>

#include "gpu/emulation/emulated_executor.h"

namespace vs::gpu {
namespace {

VS_KERNEL Note(int* out) {
  const int at = (BlockY() * 3 + BlockX()) * ThreadsInBlock() + ThreadInBlock();
  out[at] = 1000 * BlockY() + 100 * BlockX() + ThreadInBlock();
}

TEST(Simt, EveryThreadOfEveryBlockRunsOnce) {
  EmulatedLaunch launch(1);
  std::vector<int> out(size_t{3} * 2 * 64, -1);
  launch(&Note, Grid{3, 2}, 64, out.data());
  for (int y = 0; y < 2; ++y) {
    for (int x = 0; x < 3; ++x) {
      for (int t = 0; t < 64; ++t) EXPECT_EQ(out[(y * 3 + x) * 64 + t], 1000 * y + 100 * x + t);
    }
  }
}

VS_KERNEL TalkInWarps(uint32_t* out) {
  const auto t = static_cast<uint32_t>(ThreadInBlock());
  uint32_t* const mine = out + size_t{6} * t;
  mine[0] = ShuffleUp(t, 1);
  mine[1] = ShuffleDown(t, 2);
  mine[2] = ShuffleXor(t, 16);
  mine[3] = FromLane(t, 5);
  mine[4] = WarpMin(100 - t);
  mine[5] = WarpSum(t);
}

TEST(Simt, LanesTalkWithinTheirWarp) {
  EmulatedLaunch launch(2);
  std::vector<uint32_t> out(size_t{6} * 64);
  launch(&TalkInWarps, Grid{}, 64, out.data());
  const auto of = [&](int thread) {
    const auto first = out.begin() + ptrdiff_t{6} * thread;
    return std::vector<uint32_t>(first, first + 6);
  };
  EXPECT_EQ(of(0), (std::vector<uint32_t>{0, 2, 16, 5, 69, 496}));
  EXPECT_EQ(of(31), (std::vector<uint32_t>{30, 31, 15, 5, 69, 496}));
  EXPECT_EQ(of(32), (std::vector<uint32_t>{32, 34, 48, 37, 37, 496 + 32 * 32}));
}

VS_KERNEL Reverse(int* values, bool wait) {
  VS_SHARED int held[128];
  held[ThreadInBlock()] = values[ThreadInBlock()];
  if (wait) SyncBlock();
  values[ThreadInBlock()] = held[ThreadsInBlock() - 1 - ThreadInBlock()];
}

TEST(Simt, WaitingForTheBlockMattersAndForgettingItShows) {
  std::vector<int> reversed(128);
  std::iota(reversed.rbegin(), reversed.rend(), 0);
  for (uint32_t seed = 0; seed < 20; ++seed) {
    EmulatedLaunch launch(seed);
    std::vector<int> values(128);
    std::iota(values.begin(), values.end(), 0);
    launch(&Reverse, Grid{}, 128, values.data(), true);
    EXPECT_EQ(values, reversed);
    // Whoever runs first reads what is still there from before.
    std::iota(values.begin(), values.end(), 1000);
    launch(&Reverse, Grid{}, 128, values.data(), false);
    int stale = 0;
    for (const int value : values) stale += value < 1000 ? 1 : 0;
    EXPECT_GT(stale, 0);
  }
}

VS_KERNEL Count(uint32_t* sum, uint32_t* least) {
  AtomicAdd(sum, 2);
  AtomicMin(least, static_cast<uint32_t>(7 + ThreadInGrid()));
}

TEST(Simt, AtomicsSeeEveryThread) {
  EmulatedLaunch launch(3);
  uint32_t sum = 0;
  uint32_t least = 1000;
  launch(&Count, Grid{5}, 32, &sum, &least);
  EXPECT_EQ(sum, 320U);
  EXPECT_EQ(least, 7U);
}

VS_KERNEL CountWithoutAtomics(uint32_t* sum) {
  const uint32_t before = ReadShared(sum);
  *sum = before + 1;
}

TEST(Simt, WhatIsReadMayBeOld) {
  EmulatedLaunch launch(4);
  uint32_t sum = 0;
  launch(&CountWithoutAtomics, Grid{}, 128, &sum);
  EXPECT_GT(sum, 0U);
  EXPECT_LT(sum, 128U);
}

TEST(Simt, WordsOfBytesAndPairs) {
  EXPECT_EQ(BytePermute(0x33221100, 0x77665544, 0x0472), 0x00447722U);
  EXPECT_EQ(MinPairs(0x00010009, 0x00020003), 0x00010003U);
  EXPECT_EQ(AddMinPairs(0x00010009, 0x00070007, 0x00ff000f), 0x0008000fU);
  EXPECT_EQ(Both(0x0102), 0x01020102U);
}

}  // namespace
}  // namespace vs::gpu
