#include "server/streams/encoding.h"

#include <algorithm>

#include "engine/base/str.h"

namespace vs {

namespace pb = visionserver::v1;

pb::StreamKind KindOf(std::string_view port_type) {
  if (port_type == "disparity_map") return pb::STREAM_KIND_DISPARITY;
  if (port_type == "depth_map") return pb::STREAM_KIND_DEPTH;
  if (port_type == "color_image") return pb::STREAM_KIND_COLOUR_PICTURE;
  for (const std::string_view grey : {"grey_image", "frame", "stereo_frame"}) {
    if (port_type == grey) return pb::STREAM_KIND_GREY_PICTURE;
  }
  for (const std::string_view value :
       {"bool", "integer", "number", "string", "trigger", "list", "table"}) {
    if (port_type == value) return pb::STREAM_KIND_VALUE;
  }
  return pb::STREAM_KIND_UNSPECIFIED;
}

std::vector<pb::Codec> CodecsOf(pb::StreamKind kind) {
  switch (kind) {
    case pb::STREAM_KIND_DISPARITY:
    case pb::STREAM_KIND_DEPTH:
      return {pb::CODEC_RVL, pb::CODEC_RVL_ZSTD, pb::CODEC_RAW};
    case pb::STREAM_KIND_GREY_PICTURE:
    case pb::STREAM_KIND_COLOUR_PICTURE:
      return {pb::CODEC_JPEG, pb::CODEC_RAW};
    default:
      return {};
  }
}

Result<Encoding> Resolve(pb::StreamKind kind, pb::Codec codec, bool include_confidence,
                         bool include_reasons, uint32_t jpeg_quality) {
  if (kind == pb::STREAM_KIND_UNSPECIFIED) {
    return InvalidArgument("values of this type cannot be sent to clients");
  }
  if (jpeg_quality > 100) {
    return InvalidArgument(Str("jpeg_quality must be 1 to 100, or 0 for 80, not ", jpeg_quality));
  }
  if (kind == pb::STREAM_KIND_VALUE) return Encoding();
  const std::vector<pb::Codec> codecs = CodecsOf(kind);
  if (codec == pb::CODEC_UNSPECIFIED) codec = codecs.front();
  if (std::find(codecs.begin(), codecs.end(), codec) == codecs.end()) {
    std::string names;
    for (const pb::Codec one : codecs) names += (names.empty() ? "" : ", ") + pb::Codec_Name(one);
    return InvalidArgument(
        Str("this stream can be had as ", names, ", not as ",
            pb::Codec_IsValid(codec) ? pb::Codec_Name(codec) : Str("codec ", int{codec})));
  }
  Encoding encoding;
  encoding.codec = codec;
  encoding.confidence = include_confidence && kind == pb::STREAM_KIND_DISPARITY;
  encoding.reasons = include_reasons && kind == pb::STREAM_KIND_DISPARITY;
  if (codec == pb::CODEC_JPEG) {
    encoding.jpeg_quality = jpeg_quality == 0 ? 80 : static_cast<int>(jpeg_quality);
  }
  return encoding;
}

}  // namespace vs
