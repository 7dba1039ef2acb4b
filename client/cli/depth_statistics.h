#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "client/depth_frame.h"
#include "client/latest_stream.h"

namespace vs::cli {

// How a depth stream arrives. Times are passed in, in nanoseconds of any steady clock.
class DepthStatistics {
 public:
  // `latency_ms` is from exposure to this client; nothing when the clocks could not be compared.
  void Add(const client::DepthFrame& frame, std::optional<double> latency_ms, int64_t now_ns);

  int64_t frames() const { return frames_; }
  // Frames per second between the first and the last; 0 with fewer than two.
  double FramesPerSecond() const;
  // The latency that `share` (0..1) of the frames did not exceed, by nearest rank; nothing without
  // any.
  std::optional<double> LatencyMs(double share) const;
  uint64_t dropped() const { return dropped_; }
  uint64_t bytes() const { return bytes_; }

  // "29.9 fps, latency p50 12.1 ms, p95 14.0 ms, p99 19.8 ms, 0 dropped, 4.2 MB (3.3 MB/s)".
  std::string ToText() const;
  // The same as one JSON object on one line.
  std::string ToJson(const client::StreamStats& stream) const;

 private:
  double Seconds() const;

  int64_t frames_ = 0;
  int64_t first_ns_ = 0;
  int64_t last_ns_ = 0;
  uint64_t dropped_ = 0;
  uint64_t bytes_ = 0;
  std::vector<double> latencies_ms_;
};

}  // namespace vs::cli
