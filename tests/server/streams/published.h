#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "visionserver/v1/stream.pb.h"

#include "engine/core/topic.h"
#include "server/rpc/wire_message.h"

namespace vs::test {

// The journey of frame `number` through a sequence "demo" with the blocks "source" and "match".
FrameContext Journey(uint64_t number);

// A map whose pixels depend on `seed`, with invalid ones, confidence and reasons.
DisparityMap MapOf(int width, int height, int seed);

// What a client makes of the bytes.
visionserver::v1::StreamItem Parse(const WireMessage& message);

// The payload of a disparity item, unpacked; empty when it cannot be.
std::vector<uint16_t> UnpackDisparity(const visionserver::v1::StreamItem& item);
std::vector<uint16_t> PixelsOf(const Image<uint16_t>& image);

}  // namespace vs::test
