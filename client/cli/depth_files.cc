#include "client/cli/depth_files.h"

#include <google/protobuf/util/time_util.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <fstream>

#include <nlohmann/json.hpp>

#include "client/cli/png_file.h"

namespace vs::cli {
namespace {

using nlohmann::json;

std::string Rfc3339(std::chrono::system_clock::time_point time) {
  const auto ns = std::chrono::duration_cast<std::chrono::nanoseconds>(time.time_since_epoch());
  return google::protobuf::util::TimeUtil::ToString(
      google::protobuf::util::TimeUtil::NanosecondsToTimestamp(ns.count()));
}

json Metadata(const client::DepthFrame& frame, const std::string& stream, double latency_ms,
              const FileImage& image) {
  const client::Geometry& geometry = frame.geometry;
  json stages = json::array();
  for (const client::Stage& stage : frame.stages) {
    stages.push_back({{"stage", stage.name},
                      {"start_us", static_cast<double>(stage.start_ns - frame.capture_ns) / 1e3},
                      {"end_us", static_cast<double>(stage.end_ns - frame.capture_ns) / 1e3}});
  }
  return {{"stream", stream},
          {"seq", frame.seq},
          {"frame_number", frame.frame_number},
          {"dropped_before", frame.dropped},
          {"sequence_revision", frame.sequence_revision},
          {"capture_time", Rfc3339(frame.capture_time)},
          {"capture_server_monotonic_ns", frame.capture_ns},
          {"latency_ms", latency_ms < 0 ? json() : json(latency_ms)},
          {"width", frame.width},
          {"height", frame.height},
          {"disparity_px_per_value", 1 / kFileScale},
          {"invalid_value", 0},
          {"clipped_pixels", image.clipped},
          {"valid_share", frame.ValidShare()},
          {"received_bytes", frame.received_bytes},
          {"geometry",
           {{"focal_px", geometry.focal_px},
            {"baseline_m", geometry.baseline_m},
            {"cx_px", geometry.cx_px},
            {"cy_px", geometry.cy_px},
            {"principal_offset_px", geometry.principal_offset_px}}},
          {"stages", stages}};
}

}  // namespace

FileImage ToFileImage(const client::DepthFrame& frame) {
  FileImage image;
  image.pixels.reserve(frame.values.size());
  for (int y = 0; y < frame.height; ++y) {
    for (int x = 0; x < frame.width; ++x) {
      const std::optional<double> disparity_px = frame.DisparityAt(x, y);
      const double value = disparity_px ? std::round(*disparity_px * kFileScale) : 0;
      const bool fits = value >= 1 && value <= UINT16_MAX;
      if (disparity_px && !fits) ++image.clipped;
      image.pixels.push_back(fits ? static_cast<uint16_t>(value) : 0);
    }
  }
  return image;
}

client::Result<void> WriteDepthFiles(const client::DepthFrame& frame, const std::string& stream,
                                     double latency_ms, int64_t number,
                                     const std::filesystem::path& folder) {
  std::array<char, 32> name{};
  std::snprintf(name.data(), name.size(), "frame_%06lld", static_cast<long long>(number));
  const std::filesystem::path stem = folder / name.data();
  const FileImage image = ToFileImage(frame);
  bool written = WritePng16(stem.string() + ".png", frame.width, frame.height, image.pixels);
  std::ofstream text(stem.string() + ".json");
  text << Metadata(frame, stream, latency_ms, image).dump(2) << "\n";
  text.close();
  written = written && text.good();
  if (written) return {};
  return client::Failure(client::Code::kUnknown,
                         "cannot write " + stem.string() + ".png and .json; is the disk full?");
}

}  // namespace vs::cli
