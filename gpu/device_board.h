#pragma once

#include <cstddef>
#include <vector>

#include "engine/base/mutex.h"
#include "engine/base/status.h"

namespace vs::gpu {

// How many matchers work on each device, so that new ones spread, and which devices failed.
// Thread-safe.
class DeviceBoard {
 public:
  explicit DeviceBoard(int devices) : entries_(static_cast<size_t>(devices)) {}

  static constexpr int kAny = -1;

  // A matcher's place on a device, until it goes. For one thread at a time.
  class Seat {
   public:
    Seat(Seat&& other) noexcept;
    Seat& operator=(Seat&&) = delete;
    ~Seat();

    int device() const { return device_; }
    // The device does not work, and the matcher does without it ...
    void Fails(const Status& why);
    // ... until this or its end.
    void Works();

   private:
    friend class DeviceBoard;
    Seat(DeviceBoard* board, int device) : board_(board), device_(device) {}

    DeviceBoard* board_;
    int device_;
    bool failing_ = false;
  };

  // On this device; or by kAny on the one with the fewest matchers, devices that fail last, then
  // the lowest index, and none of `without`. NOT_FOUND says which devices there are. The board must
  // outlive the seat.
  Result<Seat> Take(int device, const std::vector<int>& without = {});

  struct Fault {
    int device = 0;
    int matchers = 0;  // that do without it
    Status why;        // what the last of them was told
  };
  // By device; empty when all is well.
  std::vector<Fault> Faults() const;

 private:
  struct Entry {
    int seats = 0;
    int failing = 0;
    Status why;
  };

  static int BestOf(const std::vector<Entry>& entries, const std::vector<int>& without);

  mutable Mutex mutex_;
  std::vector<Entry> entries_ VS_GUARDED_BY(mutex_);
};

}  // namespace vs::gpu
