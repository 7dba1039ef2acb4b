#include <algorithm>
#include <memory>
#include <numeric>
#include <random>
#include <utility>
#include <vector>

#include <boost/context/fiber.hpp>

#include "engine/base/check.h"
#include "gpu/kernels/simt.h"

namespace vs::gpu::emulation {

thread_local Place place;

namespace {

// Where some threads wait until `wanted` have come.
struct Gate {
  int wanted = 0;
  std::vector<int> waiting;
};

struct Warp {
  Gate gate;
  std::array<WarpValues, 2> values;
  int round = 0;
};

class Block {
 public:
  Block() = default;

  void Run(Place first, uint32_t seed, const std::function<void()>& kernel) {
    first_ = first;
    kernel_ = &kernel;
    random_.seed(seed);
    const int threads = first.threads_in_block;
    while (static_cast<int>(fibers_.size()) < threads) AddFiber();
    warps_.assign(static_cast<size_t>(threads) / kWarpSize, Warp{});
    for (Warp& warp : warps_) warp.gate.wanted = kWarpSize;
    all_ = {.wanted = threads, .waiting = {}};
    ready_.resize(static_cast<size_t>(threads));
    std::iota(ready_.begin(), ready_.end(), 0);
    running_ = threads;
    while (!ready_.empty()) Step();
    // Some wait at a gate that others never reach.
    VS_CHECK(running_ == 0);
  }

  void Pass(Gate* gate) {
    const int self = place.thread;
    gate->waiting.push_back(self);
    if (static_cast<int>(gate->waiting.size()) == gate->wanted) {
      ready_.insert(ready_.end(), gate->waiting.begin(), gate->waiting.end());
      gate->waiting.clear();
    }
    Leave();
  }
  void PassAll() { Pass(&all_); }
  void LetOthersRun() {
    if (running_ == 0 || random_() % 4 != 0) return;  // not in a kernel; or not this time
    ready_.push_back(place.thread);
    Leave();
  }
  const WarpValues& Exchange(uint32_t value) {
    Warp& warp = warps_[static_cast<size_t>(place.thread / kWarpSize)];
    const int round = warp.round;
    WarpValues& values = warp.values[static_cast<size_t>(round & 1)];
    values[static_cast<size_t>(place.thread % kWarpSize)] = value;
    // The last one to come opens the next round.
    if (static_cast<int>(warp.gate.waiting.size()) == kWarpSize - 1) ++warp.round;
    Pass(&warp.gate);
    return values;
  }

 private:
  using Fiber = boost::context::fiber;

  void AddFiber() {
    fibers_.emplace_back([this](Fiber&& back) {
      back_ = std::move(back);
      for (;;) {
        (*kernel_)();
        --running_;
        Leave();
      }
      return std::move(back_);
    });
  }
  void Step() {
    std::swap(ready_[random_() % ready_.size()], ready_.back());
    const int thread = ready_.back();
    ready_.pop_back();
    place = first_;
    place.thread = thread;
    auto& fiber = fibers_[static_cast<size_t>(thread)];
    fiber = std::move(fiber).resume();
  }
  void Leave() { back_ = std::move(back_).resume(); }

  Place first_;
  const std::function<void()>* kernel_ = nullptr;
  std::vector<Fiber> fibers_;
  Fiber back_;
  std::vector<Warp> warps_;
  Gate all_;
  std::vector<int> ready_;
  int running_ = 0;
  std::minstd_rand random_;
};

thread_local std::unique_ptr<Block> block;

}  // namespace

void Run(Grid grid, int threads_in_block, uint32_t seed, const std::function<void()>& kernel) {
  VS_CHECK(threads_in_block > 0 && threads_in_block % kWarpSize == 0);
  if (block == nullptr) block = std::make_unique<Block>();
  std::vector<int> order(static_cast<size_t>(grid.x) * grid.y);
  std::iota(order.begin(), order.end(), 0);
  std::minstd_rand random(seed + 1);
  std::shuffle(order.begin(), order.end(), random);
  for (const int k : order) {
    const Place first{
        .threads_in_block = threads_in_block, .block_x = k % grid.x, .block_y = k / grid.x};
    block->Run(first, static_cast<uint32_t>(random()), kernel);
  }
}

const WarpValues& Exchange(uint32_t value) { return block->Exchange(value); }
void WaitForBlock() { block->PassAll(); }
void LetOthersRun() {
  if (block != nullptr) block->LetOthersRun();
}

}  // namespace vs::gpu::emulation
