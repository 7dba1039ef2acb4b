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

Result<Encoding> Resolve(pb::StreamKind kind, const Encoding& wanted) {
  if (kind == pb::STREAM_KIND_UNSPECIFIED) {
    return InvalidArgument("values of this type cannot be sent to clients");
  }
  if (wanted.jpeg_quality > 100) {
    return InvalidArgument(
        Str("jpeg_quality must be 1 to 100, or 0 for 80, not ", wanted.jpeg_quality));
  }
  if (kind == pb::STREAM_KIND_VALUE) return Encoding();
  Encoding encoding = wanted;
  const std::vector<pb::Codec> codecs = CodecsOf(kind);
  if (encoding.codec == pb::CODEC_UNSPECIFIED) encoding.codec = codecs.front();
  if (std::find(codecs.begin(), codecs.end(), encoding.codec) == codecs.end()) {
    std::string names;
    for (const pb::Codec one : codecs) names += (names.empty() ? "" : ", ") + pb::Codec_Name(one);
    return InvalidArgument(Str("this stream can be had as ", names, ", not as ",
                               pb::Codec_IsValid(encoding.codec)
                                   ? pb::Codec_Name(encoding.codec)
                                   : Str("codec ", int{encoding.codec})));
  }
  if (kind != pb::STREAM_KIND_DISPARITY) encoding.confidence = encoding.reasons = false;
  if (encoding.codec != pb::CODEC_JPEG) {
    encoding.jpeg_quality = 0;
  } else if (encoding.jpeg_quality == 0) {
    encoding.jpeg_quality = 80;
  }
  return encoding;
}

}  // namespace vs
