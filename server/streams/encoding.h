#pragma once

#include <compare>
#include <cstdint>
#include <string_view>
#include <vector>

#include "visionserver/v1/stream.pb.h"

#include "engine/base/status.h"

namespace vs {

// How one kind of item is packed. Subscribers with equal encodings share the bytes.
struct Encoding {
  visionserver::v1::Codec codec = visionserver::v1::CODEC_UNSPECIFIED;
  bool confidence = false;
  bool reasons = false;
  uint32_t jpeg_quality = 0;  // 0 unless the codec is JPEG
  uint32_t max_width_px = 0;  // reduced to at most this; 0 for full size

  auto operator<=>(const Encoding&) const = default;  // NOLINT(modernize-use-nullptr): none here
};

// What clients see of a topic whose values have this port type; UNSPECIFIED: cannot be sent.
visionserver::v1::StreamKind KindOf(std::string_view port_type);

// The codecs that a kind can be had in, the usual one first.
std::vector<visionserver::v1::Codec> CodecsOf(visionserver::v1::StreamKind kind);

// What a Subscription or GetLatestRequest asks for.
template <class Request>
Encoding WantedBy(const Request& request) {
  return {.codec = request.codec(),
          .confidence = request.include_confidence(),
          .reasons = request.include_reasons(),
          .jpeg_quality = request.jpeg_quality(),
          .max_width_px = request.max_width_px()};
}

// What a client asked for, with the server's choices filled in. INVALID_ARGUMENT when the codec
// does not fit the kind or the quality is out of range.
Result<Encoding> Resolve(visionserver::v1::StreamKind kind, const Encoding& wanted);

}  // namespace vs
