// What all threads of a block up to this one have together.
#pragma once

#include <cstdint>

#include "gpu/kernels/simt.h"

namespace vs::gpu {

struct Plus {
  VS_DEVICE uint32_t operator()(uint32_t a, uint32_t b) const { return a + b; }
};
struct Greatest {
  VS_DEVICE uint32_t operator()(uint32_t a, uint32_t b) const { return Greater(a, b); }
};

// Joins the values of threads 0 .. this one (Hillis, Steele 1986). `room` has one word for each
// thread; afterwards room[t] is what thread t got, until a thread changes it.
template <class Join>
VS_DEVICE uint32_t JoinUpToHere(uint32_t value, Join join, uint32_t* room) {
  const int self = ThreadInBlock();
  SyncBlock();  // nobody reads any more what was there
  room[self] = value;
  for (int reach = 1; reach < ThreadsInBlock(); reach *= 2) {
    SyncBlock();
    const uint32_t before = self >= reach ? room[self - reach] : room[self];
    SyncBlock();
    if (self >= reach) room[self] = join(before, room[self]);
  }
  SyncBlock();
  return room[self];
}

}  // namespace vs::gpu
