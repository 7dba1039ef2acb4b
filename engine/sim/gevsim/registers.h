#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "engine/base/mutex.h"
#include "engine/sim/gevsim/gvcp.h"
#include "engine/sim/sensor.h"

namespace vs::sim {

// What a device says about itself.
struct DeviceIdentity {
  std::string serial_number;
  std::string user_name;
  uint32_t address = 0;  // IPv4, host byte order
  uint32_t subnet_mask = 0;
  int sensor_width = 0;
  int sensor_height = 0;
  int64_t tick_hz = 1'000'000'000;
  uint32_t heartbeat_timeout_ms = 3000;
};

// The memory of a GigE Vision device: registers of four bytes at the addresses of
// register_addresses.h, and behind them the XML that explains the features to clients. Clients get
// at it through Read and Write, which refuse what a real camera refuses; the device itself through
// Get and Set. Thread-safe.
class Registers {
 public:
  Registers(const DeviceIdentity& identity, std::string_view xml);

  // Any number of bytes from a multiple of 4.
  GevStatus Read(uint32_t address, std::span<uint8_t> bytes) const;
  // Whole registers. Values are checked against the register's range, as it is now; a change of
  // binning shrinks or grows the window.
  GevStatus Write(uint32_t address, std::span<const uint8_t> bytes);

  uint32_t Get(uint32_t address) const;
  void Set(uint32_t address, uint32_t value);

  // The sensor's settings as the registers have them now.
  SensorSettings Sensor() const;
  // From one picture to the next of a free-running camera.
  int64_t PeriodNs() const;

 private:
  GevStatus WriteWord(uint32_t address, uint32_t value) VS_REQUIRES(mutex_);
  bool WithinRange(uint32_t address, uint32_t value) const VS_REQUIRES(mutex_);
  void AdjustTo(uint32_t address, uint32_t old_value) VS_REQUIRES(mutex_);
  void Rescale(uint32_t size, uint32_t offset, uint32_t size_max, uint32_t old_binning)
      VS_REQUIRES(mutex_);
  uint32_t Word(uint32_t address) const VS_REQUIRES(mutex_);
  void SetWord(uint32_t address, uint32_t value) VS_REQUIRES(mutex_);
  void SetText(uint32_t address, size_t size, std::string_view text) VS_REQUIRES(mutex_);

  mutable Mutex mutex_;
  std::vector<uint8_t> memory_ VS_GUARDED_BY(mutex_);  // 64 KiB and the XML
};

}  // namespace vs::sim
