#include <gtest/gtest.h>
#include <png.h>

#include <fstream>

#include <nlohmann/json.hpp>

#include "client/cli/depth_files.h"
#include "client/cli/depth_statistics.h"
#include "tests/support/temp_folder.h"

namespace vs::cli {
namespace {

client::DepthFrame Frame() {
  client::DepthFrame frame;
  frame.width = 3;
  frame.height = 1;
  frame.values = {0, 1600, 4095};  // invalid, 100 px, 255.94 px
  frame.scale = 1.0 / 16;
  frame.geometry = {.focal_px = 800, .baseline_m = 0.1, .cx_px = 320, .cy_px = 240};
  frame.seq = 12;
  frame.dropped = 2;
  frame.frame_number = 34;
  frame.capture_ns = 5'000'000;
  frame.capture_time = std::chrono::system_clock::time_point(std::chrono::seconds(1'700'000'000));
  frame.stages = {{.name = "match", .start_ns = 6'000'000, .end_ns = 8'500'000}};
  frame.received_bytes = 1000;
  return frame;
}

// Width, height, bit depth and pixels of a PNG of one channel, by libpng's plain reading.
std::vector<uint16_t> ReadPng(const std::filesystem::path& path, int* width, int* height) {
  std::FILE* file = std::fopen(path.c_str(), "rbe");
  png_structp png = png_create_read_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
  png_infop info = png_create_info_struct(png);
  png_init_io(png, file);
  png_read_png(png, info, PNG_TRANSFORM_SWAP_ENDIAN, nullptr);
  *width = static_cast<int>(png_get_image_width(png, info));
  *height = static_cast<int>(png_get_image_height(png, info));
  EXPECT_EQ(16, png_get_bit_depth(png, info));
  EXPECT_EQ(PNG_COLOR_TYPE_GRAY, png_get_color_type(png, info));
  std::vector<uint16_t> pixels;
  for (int y = 0; y < *height; ++y) {
    const auto* row = reinterpret_cast<const uint16_t*>(png_get_rows(png, info)[y]);
    pixels.insert(pixels.end(), row, row + *width);
  }
  png_destroy_read_struct(&png, &info, nullptr);
  std::fclose(file);
  return pixels;
}

TEST(DepthFiles, HoldDisparityInSteps256ToThePixel) {
  const test::TempFolder folder;
  ASSERT_TRUE(WriteDepthFiles(Frame(), "stereo/depth", 7.5, 3, folder.path()));
  int width = 0;
  int height = 0;
  EXPECT_EQ((std::vector<uint16_t>{0, 25600, 65520}),
            ReadPng(folder / "frame_000003.png", &width, &height));
  EXPECT_EQ(3, width);
  EXPECT_EQ(1, height);
}

TEST(DepthFiles, SayBesideThePictureWhatBelongsToIt) {
  const test::TempFolder folder;
  ASSERT_TRUE(WriteDepthFiles(Frame(), "stereo/depth", 7.5, 1, folder.path()));
  std::ifstream file(folder / "frame_000001.json");
  const nlohmann::json root = nlohmann::json::parse(file);
  EXPECT_EQ("stereo/depth", root.at("stream"));
  EXPECT_EQ(12, root.at("seq"));
  EXPECT_EQ(34, root.at("frame_number"));
  EXPECT_EQ(2, root.at("dropped_before"));
  EXPECT_EQ("2023-11-14T22:13:20Z", root.at("capture_time"));
  EXPECT_EQ(7.5, root.at("latency_ms"));
  EXPECT_EQ(1.0 / 256, root.at("disparity_px_per_value"));
  EXPECT_EQ(800, root.at("geometry").at("focal_px"));
  EXPECT_EQ(0.1, root.at("geometry").at("baseline_m"));
  EXPECT_EQ("match", root.at("stages")[0].at("stage"));
  EXPECT_EQ(1000, root.at("stages")[0].at("start_us"));
  EXPECT_EQ(3500, root.at("stages")[0].at("end_us"));
}

TEST(DepthFiles, CountDisparitiesThatDoNotFit) {
  client::DepthFrame frame = Frame();
  frame.offset = 100;
  const FileImage image = ToFileImage(frame);
  EXPECT_EQ((std::vector<uint16_t>{0, 51200, 0}), image.pixels);
  EXPECT_EQ(1U, image.clipped);
}

TEST(DepthFiles, SayThatAFolderCannotBeWritten) {
  const auto written = WriteDepthFiles(Frame(), "stereo/depth", -1, 1, "/no/such/folder");
  ASSERT_FALSE(written);
  EXPECT_NE(std::string::npos, written.error().message.find("/no/such/folder/frame_000001.png"));
}

TEST(DepthStatistics, KnowRateLatencyDropsAndBytes) {
  DepthStatistics statistics;
  for (int i = 0; i < 101; ++i) {
    // 100 steps of 20 ms are two seconds; latencies 1, 2 ... 101 ms.
    statistics.Add(Frame(), 1.0 + i, int64_t{20'000'000} * i);
  }
  EXPECT_EQ(101, statistics.frames());
  EXPECT_DOUBLE_EQ(50, statistics.FramesPerSecond());
  EXPECT_EQ(51, *statistics.LatencyMs(0.50));
  EXPECT_EQ(96, *statistics.LatencyMs(0.95));
  EXPECT_EQ(100, *statistics.LatencyMs(0.99));
  EXPECT_EQ(101, *statistics.LatencyMs(1.0));
  EXPECT_EQ(200U, statistics.dropped());  // not those before the first frame
  EXPECT_EQ(101'000U, statistics.bytes());
  EXPECT_EQ(
      "50.0 fps, latency p50 51.0 ms, p95 96.0 ms, p99 100.0 ms, 200 dropped, 0.1 MB (0.1 MB/s)",
      statistics.ToText());
}

TEST(DepthStatistics, SayNothingThatTheyDoNotKnow) {
  DepthStatistics statistics;
  EXPECT_EQ(0, statistics.FramesPerSecond());
  EXPECT_FALSE(statistics.LatencyMs(0.5));
  statistics.Add(Frame(), std::nullopt, 1);
  EXPECT_EQ("0.0 fps, 0 dropped, 0.0 MB", statistics.ToText());
  const nlohmann::json root = nlohmann::json::parse(statistics.ToJson({.reconnects = 2}));
  EXPECT_TRUE(root.at("latency_p50_ms").is_null());
  EXPECT_EQ(2, root.at("reconnects"));
}

}  // namespace
}  // namespace vs::cli
