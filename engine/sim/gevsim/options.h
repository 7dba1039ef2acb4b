#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "engine/sim/device_clock.h"

namespace vs::sim {

// What the command line of gevsim says.
struct Options {
  std::string left_address = "127.0.0.1";
  std::string right_address = "127.0.0.2";
  std::string only;  // "left" or "right": serve this camera alone
  double line_hz = 30;
  double noise = 1;
  uint64_t seed = 1;
  double right_sensitivity = 1.03;
  bool ideal = false;
  double link_mbps = 1000;
  int first_block_id = 65500;
  int64_t tick_hz = 1'000'000'000;
  double left_offset_ms = 0;
  double right_offset_ms = 0;
  double left_drift_ppm = 0;
  double right_drift_ppm = 0;
  std::string folder;
  std::string left_pattern = "*left*";
  std::string right_pattern = "*right*";
  std::vector<std::string> faults;  // "[left|right] FAULT"
  std::string control_path;
  double duration_s = 0;  // 0 = until a signal comes

  DeviceClock LeftClock() const;
  DeviceClock RightClock() const;
  // Between two pulses of the line; a second if there are none.
  int64_t PicturePeriodNs() const;
};

// The options, or the exit code with which the program is to end at once (help was asked for, or
// the command line makes no sense; either has been said on the terminal).
struct ParsedOptions {
  Options options;
  std::optional<int> exit_code;
};
ParsedOptions ParseOptions(int argc, char** argv);

}  // namespace vs::sim
