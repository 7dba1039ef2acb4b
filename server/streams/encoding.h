#pragma once

#include <compare>
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
  int jpeg_quality = 0;  // 0 unless the codec is JPEG

  auto operator<=>(const Encoding&) const = default;  // NOLINT(modernize-use-nullptr): none here
};

// What clients see of a topic whose values have this port type; UNSPECIFIED: cannot be sent.
visionserver::v1::StreamKind KindOf(std::string_view port_type);

// The codecs that a kind can be had in, the usual one first.
std::vector<visionserver::v1::Codec> CodecsOf(visionserver::v1::StreamKind kind);

// What a client asked for, with the server's choices filled in. INVALID_ARGUMENT when the codec
// does not fit the kind or the quality is out of range.
Result<Encoding> Resolve(visionserver::v1::StreamKind kind, visionserver::v1::Codec codec,
                         bool include_confidence, bool include_reasons, uint32_t jpeg_quality);

}  // namespace vs
