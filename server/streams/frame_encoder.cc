#include "server/streams/frame_encoder.h"

#include <algorithm>
#include <utility>

#include "engine/base/str.h"
#include "proto/wire/rvl.h"
#include "server/convert/frame_header.h"
#include "server/convert/value.h"
#include "server/streams/reduce.h"

namespace vs {
namespace {

namespace pb = visionserver::v1;

static_assert(int{pb::INVALID_REASON_FILTERED} == static_cast<int>(InvalidReason::kFiltered) &&
                  kInvalidReasonCount == pb::InvalidReason_MAX + 1,
              "the API's reasons are the engine's, number by number");

// Protobuf's wire form of a length-delimited field: tag, length, bytes.
void AddBytesField(int field, WireSlice bytes, WireMessage* message) {
  std::string head;
  const auto add_varint = [&head](uint64_t number) {
    for (; number >= 0x80; number >>= 7) head += static_cast<char>(number | 0x80);
    head += static_cast<char>(number);
  };
  add_varint(static_cast<uint64_t>(field) << 3 | 2);
  add_varint(bytes.size_bytes);
  message->push_back(ToSlice(std::move(head)));
  message->push_back(std::move(bytes));
}

template <class Pixel>
WireSlice RawSlice(const Image<Pixel>& image, const std::shared_ptr<const void>& owner) {
  const size_t row_bytes = static_cast<size_t>(image.width()) * sizeof(Pixel);
  const auto* pixels = reinterpret_cast<const char*>(image.Row(0));
  if (image.stride_bytes() == row_bytes && image.buffer().place != Place::kForeign) {
    return {.data = pixels, .size_bytes = row_bytes * image.height(), .owner = owner};
  }
  std::string bytes;
  bytes.reserve(row_bytes * image.height());
  for (int y = 0; y < image.height(); ++y) {
    bytes.append(reinterpret_cast<const char*>(image.Row(y)), row_bytes);
  }
  return ToSlice(std::move(bytes));
}

WireSlice CopyOf(const std::vector<uint8_t>& bytes, size_t size) {
  return ToSlice(std::string(reinterpret_cast<const char*>(bytes.data()), size));
}

template <class Pixel>
void Describe(const Image<Pixel>& image, size_t raw_bytes_per_pixel, pb::FrameHeader* header) {
  header->set_width(static_cast<uint32_t>(image.width()));
  header->set_height(static_cast<uint32_t>(image.height()));
  header->set_raw_bytes(static_cast<uint64_t>(image.width()) * image.height() *
                        raw_bytes_per_pixel);
}

}  // namespace

std::shared_ptr<const EncodedItem> FrameEncoder::Encode(const std::shared_ptr<const Sample>& sample,
                                                        uint64_t seq, const Encoding& encoding) {
  const int64_t start_ns = clock_.MonotonicNs();
  auto encoded = std::make_shared<EncodedItem>();
  encoded->seq = seq;
  Parts parts{.sample = sample, .encoding = encoding};
  parts.item.set_seq(seq);
  pb::FrameHeader* header = parts.item.mutable_header();
  header->set_kind(KindOf(TypeName(sample->value)));
  header->set_codec(encoding.codec);
  FillJourney(*sample, clock_, header);
  encoded->status = Build(&parts);
  if (!encoded->status.ok()) return encoded;
  pb::StageTiming* timing = header->add_timing();
  timing->set_stage("encode");
  timing->set_start_ns(start_ns);
  timing->set_end_ns(clock_.MonotonicNs());
  encoded->message = Serialize(parts.item);
  for (WireSlice& slice : parts.planes) encoded->message.push_back(std::move(slice));
  return encoded;
}

Status FrameEncoder::Build(Parts* parts) {
  const Value& value = parts->sample->value;
  const std::vector<pb::Codec> codecs = CodecsOf(parts->item.header().kind());
  if (!codecs.empty() &&
      std::find(codecs.begin(), codecs.end(), parts->encoding.codec) == codecs.end()) {
    return FailedPrecondition("the stream carries another type than before: subscribe again");
  }
  if (const auto* map = value.GetIf<DisparityMap>()) return Add(*map, parts);
  if (const auto* map = value.GetIf<DepthMap>()) return Add(*map, parts);
  if (const auto* image = value.GetIf<GreyImage>()) return AddPicture(*image, parts);
  if (const auto* image = value.GetIf<ColorImage>()) return AddPicture(*image, parts);
  if (const auto* frame = value.GetIf<Frame>()) return AddPicture(frame->image, parts);
  if (const auto* pair = value.GetIf<StereoFrame>()) return AddPicture(pair->left->image, parts);
  *parts->item.mutable_value() = ToProto(value);
  return Status();
}

template <class Pixel>
int FrameEncoder::ChooseStep(const Image<Pixel>& image, Parts* parts) {
  parts->step = ReducingStep(image.width(), parts->encoding.max_width_px);
  parts->item.mutable_header()->set_step(static_cast<uint32_t>(parts->step));
  return parts->step;
}

Status FrameEncoder::Add(DisparityMap map, Parts* parts) {
  pb::FrameHeader* header = parts->item.mutable_header();
  if (const int step = ChooseStep(map.disparity, parts); step > 1) {
    map.disparity = Nearest(map.disparity, step, pool_);
    if (parts->encoding.confidence) map.confidence = Nearest(map.confidence, step, pool_);
    if (parts->encoding.reasons) map.reason = Nearest(map.reason, step, pool_);
  }
  Describe(map.disparity, sizeof(uint16_t), header);
  header->set_value_scale(1.0 / kDisparityScale);
  header->set_value_offset(map.offset_px);
  *header->mutable_geometry() = ToProto(map.geometry);
  if (parts->encoding.confidence) {
    AddBytesField(pb::StreamItem::kConfidenceFieldNumber, Plane(map.confidence, *parts),
                  &parts->planes);
  }
  if (parts->encoding.reasons) {
    AddBytesField(pb::StreamItem::kReasonsFieldNumber, Plane(map.reason, *parts), &parts->planes);
  }
  AddBytesField(pb::StreamItem::kPayloadFieldNumber, Plane(map.disparity, *parts), &parts->planes);
  return Status();
}

Status FrameEncoder::Add(DepthMap map, Parts* parts) {
  pb::FrameHeader* header = parts->item.mutable_header();
  if (const int step = ChooseStep(map.depth_m, parts); step > 1) {
    map.depth_m = Nearest(map.depth_m, step, pool_);
  }
  *header->mutable_geometry() = ToProto(map.geometry);
  WireSlice payload;
  if (parts->encoding.codec == pb::CODEC_RAW) {
    Describe(map.depth_m, sizeof(float), header);
    payload = RawSlice(map.depth_m, OwnerOf(map.depth_m, *parts));
  } else {
    ToSteps(map.depth_m, &depth_steps_);
    Describe(map.depth_m, sizeof(uint16_t), header);
    header->set_value_scale(depth_steps_.step_m);
    const auto width = static_cast<size_t>(map.depth_m.width());
    payload = Pack(depth_steps_.steps.data(), width, static_cast<size_t>(map.depth_m.height()),
                   width * sizeof(uint16_t), parts->encoding.codec);
  }
  AddBytesField(pb::StreamItem::kPayloadFieldNumber, std::move(payload), &parts->planes);
  return Status();
}

template <class Pixel>
Status FrameEncoder::AddPicture(Image<Pixel> image, Parts* parts) {
  if (const int step = ChooseStep(image, parts); step > 1) image = Mean(image, step, pool_);
  Describe(image, sizeof(Pixel), parts->item.mutable_header());
  WireSlice payload;
  if (parts->encoding.codec == pb::CODEC_JPEG) {
    const auto quality = static_cast<int>(parts->encoding.jpeg_quality);
    VS_RETURN_IF_ERROR(jpeg_.Encode(image, quality, &scratch_));
    payload = CopyOf(scratch_, scratch_.size());
  } else {
    payload = RawSlice(image, OwnerOf(image, *parts));
  }
  AddBytesField(pb::StreamItem::kPayloadFieldNumber, std::move(payload), &parts->planes);
  return Status();
}

// What keeps the pixels while they are sent: those that were published, or the reduced ones.
template <class Pixel>
std::shared_ptr<const void> FrameEncoder::OwnerOf(const Image<Pixel>& image, const Parts& parts) {
  if (parts.step > 1) return image.buffer().owner;
  return parts.sample;
}

template <class Pixel>
WireSlice FrameEncoder::Plane(const Image<Pixel>& image, const Parts& parts) {
  if (parts.encoding.codec == pb::CODEC_RAW) return RawSlice(image, OwnerOf(image, parts));
  return Pack(image.Row(0), static_cast<size_t>(image.width()), static_cast<size_t>(image.height()),
              image.stride_bytes(), parts.encoding.codec);
}

template <class Pixel>
WireSlice FrameEncoder::Pack(const Pixel* pixels, size_t width, size_t height, size_t stride_bytes,
                             pb::Codec codec) {
  scratch_.resize(wire::RvlBound(width * height));
  const size_t size = wire::EncodeRvl(pixels, width, height, stride_bytes, scratch_);
  if (codec != pb::CODEC_RVL_ZSTD) return CopyOf(scratch_, size);
  zstd_scratch_.resize(wire::ZstdPacker::Bound(size));
  return CopyOf(zstd_scratch_, zstd_.Pack({scratch_.data(), size}, zstd_scratch_));
}

}  // namespace vs
