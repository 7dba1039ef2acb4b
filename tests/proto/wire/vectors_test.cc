// The same file is read by the decoders of other languages.
#include <gtest/gtest.h>

#include <fstream>
#include <map>
#include <string>

#include <nlohmann/json.hpp>

#include "proto/wire/rvl.h"
#include "proto/wire/zstd.h"
#include "tests/proto/wire/images.h"

namespace vs::wire {
namespace {

nlohmann::json Vectors() {
  std::ifstream file(VS_WIRE_VECTORS);
  return nlohmann::json::parse(file);
}

std::vector<uint8_t> Bytes(const std::string& hex) {
  std::vector<uint8_t> bytes;
  for (size_t i = 0; i < hex.size(); i += 2) {
    bytes.push_back(static_cast<uint8_t>(std::stoi(hex.substr(i, 2), nullptr, 16)));
  }
  return bytes;
}

TEST(RvlVectors, ImagesPackAndUnpackAsWritten) {
  const nlohmann::json images = Vectors().at("images");
  ASSERT_GE(images.size(), 9U);
  for (const nlohmann::json& image : images) {
    SCOPED_TRACE(image.at("name"));
    const auto pixels = image.at("pixels").get<std::vector<uint16_t>>();
    ASSERT_EQ(pixels.size(), image.at("width").get<size_t>() * image.at("height").get<size_t>());
    const std::vector<uint8_t> packed = Bytes(image.at("rvl"));
    EXPECT_EQ(packed, Packed(pixels));
    std::vector<uint16_t> unpacked(pixels.size());
    EXPECT_EQ(DecodeError::kNone, DecodeRvl(packed, unpacked));
    EXPECT_EQ(pixels, unpacked);
  }
}

TEST(RvlVectors, ZstdFramesHoldTheRvlBytes) {
  int seen = 0;
  const nlohmann::json images = Vectors().at("images");
  for (const nlohmann::json& image : images) {
    if (!image.contains("rvl_zstd")) continue;
    ++seen;
    std::vector<uint8_t> rvl;
    EXPECT_EQ(DecodeError::kNone, ZstdUnpacker().Unpack(Bytes(image.at("rvl_zstd")), 10000, &rvl));
    EXPECT_EQ(Bytes(image.at("rvl")), rvl);
  }
  EXPECT_EQ(2, seen);
}

TEST(RvlVectors, FaultsAreRefusedForTheirReason) {
  const std::map<std::string, DecodeError> errors = {
      {"truncated", DecodeError::kTruncated},
      {"bad run", DecodeError::kBadRun},
      {"value out of range", DecodeError::kValueOutOfRange},
      {"trailing bytes", DecodeError::kTrailingBytes}};
  const nlohmann::json faults = Vectors().at("faults");
  ASSERT_GE(faults.size(), 12U);
  for (const nlohmann::json& fault : faults) {
    SCOPED_TRACE(fault.at("name"));
    const size_t size = fault.at("width").get<size_t>() * fault.at("height").get<size_t>();
    std::vector<uint16_t> pixels(size);
    EXPECT_EQ(errors.at(fault.at("error")), DecodeRvl(Bytes(fault.at("rvl")), pixels));
  }
}

}  // namespace
}  // namespace vs::wire
