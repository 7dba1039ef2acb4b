#include "client/cli/depth_statistics.h"

#include <algorithm>
#include <cmath>

#include <nlohmann/json.hpp>

#include "client/cli/output.h"

namespace vs::cli {
namespace {

constexpr double kMegabyte = 1e6;

}  // namespace

void DepthStatistics::Add(const client::DepthFrame& frame, std::optional<double> latency_ms,
                          int64_t now_ns) {
  if (frames_ == 0) {
    first_ns_ = now_ns;
  } else {
    dropped_ += frame.dropped;  // what was before the first frame was never asked for
  }
  ++frames_;
  last_ns_ = now_ns;
  bytes_ += frame.received_bytes;
  if (latency_ms) latencies_ms_.push_back(*latency_ms);
}

double DepthStatistics::Seconds() const { return static_cast<double>(last_ns_ - first_ns_) / 1e9; }

double DepthStatistics::FramesPerSecond() const {
  return frames_ < 2 || Seconds() <= 0 ? 0 : static_cast<double>(frames_ - 1) / Seconds();
}

std::optional<double> DepthStatistics::LatencyMs(double share) const {
  if (latencies_ms_.empty()) return std::nullopt;
  std::vector<double> sorted = latencies_ms_;
  const double rank = std::ceil(share * static_cast<double>(sorted.size()));
  const auto index = static_cast<std::ptrdiff_t>(std::max(rank, 1.0)) - 1;
  std::nth_element(sorted.begin(), sorted.begin() + index, sorted.end());
  return sorted[static_cast<size_t>(index)];
}

std::string DepthStatistics::ToText() const {
  std::string text = NumberText(FramesPerSecond(), 1) + " fps";
  if (!latencies_ms_.empty()) {
    text += ", latency p50 " + NumberText(*LatencyMs(0.5), 1) + " ms, p95 " +
            NumberText(*LatencyMs(0.95), 1) + " ms, p99 " + NumberText(*LatencyMs(0.99), 1) + " ms";
  }
  const double megabytes = static_cast<double>(bytes_) / kMegabyte;
  text += ", " + std::to_string(dropped_) + " dropped, " + NumberText(megabytes, 1) + " MB";
  if (Seconds() > 0) text += " (" + NumberText(megabytes / Seconds(), 1) + " MB/s)";
  return text;
}

std::string DepthStatistics::ToJson(const client::StreamStats& stream) const {
  const auto latency = [this](double share) {
    const std::optional<double> ms = LatencyMs(share);
    return ms ? nlohmann::json(*ms) : nlohmann::json();
  };
  const nlohmann::json root = {{"frames", frames_},
                               {"fps", FramesPerSecond()},
                               {"seconds", Seconds()},
                               {"latency_p50_ms", latency(0.5)},
                               {"latency_p95_ms", latency(0.95)},
                               {"latency_p99_ms", latency(0.99)},
                               {"dropped", dropped_},
                               {"bytes", bytes_},
                               {"reconnects", stream.reconnects}};
  return root.dump();
}

}  // namespace vs::cli
