#include "engine/sim/gevsim/options.h"

#include <cstdio>

#include <CLI/CLI.hpp>

namespace vs::sim {
namespace {

constexpr int kExitUsage = 2;

DeviceClock ClockOf(int64_t tick_hz, double offset_ms, double drift_ppm) {
  return {.tick_hz = tick_hz,
          .offset_ns = static_cast<int64_t>(offset_ms * 1e6),
          .drift_ppm = drift_ppm};
}

}  // namespace

DeviceClock Options::LeftClock() const { return ClockOf(tick_hz, left_offset_ms, left_drift_ppm); }
DeviceClock Options::RightClock() const {
  return ClockOf(tick_hz, right_offset_ms, right_drift_ppm);
}

int64_t Options::PicturePeriodNs() const {
  return static_cast<int64_t>(1e9 / (line_hz > 0 ? line_hz : 1));
}

ParsedOptions ParseOptions(int argc, char** argv) {
  ParsedOptions parsed;
  Options& o = parsed.options;
  CLI::App app(
      "Two simulated GigE Vision cameras (Basler acA1300-30gm, serial numbers 21000001 and "
      "21000002) that look at a simulated scene or show pictures from a folder.",
      "gevsim");
  app.add_option("--left", o.left_address, "IPv4 address of the left camera")
      ->capture_default_str();
  app.add_option("--right", o.right_address, "IPv4 address of the right camera")
      ->capture_default_str();
  app.add_option("--only", o.only, "Serve this camera alone")
      ->check(CLI::IsMember({"left", "right"}));
  app.add_option("--fps", o.line_hz,
                 "Pulses per second on trigger input Line1 of both cameras; 0 for none")
      ->check(CLI::Range(0.0, 1000.0))
      ->capture_default_str();
  app.add_option("--noise", o.noise, "Noise of the pictures; 0 for none, 1 for a real camera's")
      ->check(CLI::Range(0.0, 100.0))
      ->capture_default_str();
  app.add_option("--seed", o.seed, "Which noise")->capture_default_str();
  app.add_option("--right-sensitivity", o.right_sensitivity,
                 "How much brighter the right camera's pictures are")
      ->check(CLI::Range(0.1, 10.0))
      ->capture_default_str();
  app.add_flag("--ideal", o.ideal, "Cameras without misalignment and distortion");
  app.add_option("--folder", o.folder, "Show the pairs of pictures in this folder, over and over")
      ->check(CLI::ExistingDirectory);
  app.add_option("--left-pattern", o.left_pattern, "File names of left pictures, with * and ?")
      ->capture_default_str();
  app.add_option("--right-pattern", o.right_pattern, "File names of right pictures")
      ->capture_default_str();
  app.add_option("--link-mbps", o.link_mbps,
                 "Speed of each camera's network link in Mbit/s; 0 for as fast as possible")
      ->check(CLI::Range(0.0, 1e6))
      ->capture_default_str();
  app.add_option("--first-block-id", o.first_block_id, "Number of each stream's first frame")
      ->check(CLI::Range(1, 65535))
      ->capture_default_str();
  app.add_option("--tick-hz", o.tick_hz, "Rate of the cameras' timestamps")
      ->check(CLI::Range(int64_t{1000}, int64_t{1'000'000'000}))
      ->capture_default_str();
  app.add_option("--left-offset-ms", o.left_offset_ms, "How far the left camera's clock is ahead");
  app.add_option("--right-offset-ms", o.right_offset_ms,
                 "How far the right camera's clock is ahead");
  app.add_option("--left-drift-ppm", o.left_drift_ppm, "How fast the left camera's clock gains");
  app.add_option("--right-drift-ppm", o.right_drift_ppm, "How fast the right camera's clock gains");
  app.add_option("--fault", o.faults,
                 "Something to do wrong from the start, for example 'left drop 0.01'; repeatable");
  app.add_option("--control", o.control_path,
                 "Take commands (faults, 'trigger', 'stats') on a Unix socket with this path");
  app.add_option("--duration", o.duration_s, "End by itself after so many seconds")
      ->check(CLI::Range(0.0, 1e9));
  try {
    app.parse(argc, argv);
  } catch (const CLI::Success& answered) {
    parsed.exit_code = app.exit(answered);
  } catch (const CLI::ParseError& error) {
    std::fprintf(stderr, "gevsim: %s (gevsim --help says more)\n", error.what());
    parsed.exit_code = kExitUsage;
  }
  return parsed;
}

}  // namespace vs::sim
