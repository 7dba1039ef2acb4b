#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "engine/base/clock.h"
#include "engine/base/status.h"
#include "engine/core/topic.h"
#include "engine/image/buffer.h"
#include "proto/wire/zstd.h"
#include "server/rpc/wire_message.h"
#include "server/streams/depth_steps.h"
#include "server/streams/encoding.h"
#include "server/streams/jpeg_encoder.h"

namespace vs {

// The part of a StreamItem that is the same for all subscribers, serialised once: everything but
// subscription_id, dropped and sent_ns, which each puts in front.
struct EncodedItem {
  uint64_t seq = 0;
  Status status;  // why there is nothing to send; then `message` is empty
  WireMessage message;
};

// Packs published values for clients. Keeps its working memory from item to item. Not for two
// threads at once.
class FrameEncoder {
 public:
  explicit FrameEncoder(const Clock& clock) : clock_(clock) {}

  // `seq` is what clients see. With CODEC_RAW the message points into the published pixels, which
  // it keeps alive; pixels in a camera's own memory are copied, so that a slow client cannot keep a
  // camera from its buffers.
  std::shared_ptr<const EncodedItem> Encode(const std::shared_ptr<const Sample>& sample,
                                            uint64_t seq, const Encoding& encoding);

 private:
  // What one item consists of while it is made.
  struct Parts {
    std::shared_ptr<const Sample> sample;
    Encoding encoding;
    int step = 1;                       // FrameHeader.step
    visionserver::v1::StreamItem item;  // without the planes
    WireMessage planes;                 // fields of the item, each as tag and bytes
  };

  Status Build(Parts* parts);
  template <class Pixel>
  static int ChooseStep(const Image<Pixel>& image, Parts* parts);
  template <class Pixel>
  static std::shared_ptr<const void> OwnerOf(const Image<Pixel>& image, const Parts& parts);
  Status Add(DisparityMap map, Parts* parts);
  Status Add(DepthMap map, Parts* parts);
  template <class Pixel>
  Status AddPicture(Image<Pixel> image, Parts* parts);
  // The image as the codec wants it: raw, as RVL, or as RVL and zstd.
  template <class Pixel>
  WireSlice Plane(const Image<Pixel>& image, const Parts& parts);
  template <class Pixel>
  WireSlice Pack(const Pixel* pixels, size_t width, size_t height, size_t stride_bytes,
                 visionserver::v1::Codec codec);

  const Clock& clock_;
  BufferPool pool_;  // of reduced images
  JpegEncoder jpeg_;
  wire::ZstdPacker zstd_;
  DepthSteps depth_steps_;
  std::vector<uint8_t> scratch_;
  std::vector<uint8_t> zstd_scratch_;
};

}  // namespace vs
