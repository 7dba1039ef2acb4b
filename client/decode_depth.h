#pragma once

#include "visionserver/v1/stream.pb.h"

#include "client/depth_frame.h"
#include "client/error.h"
#include "proto/wire/zstd.h"

namespace vs::client {

// Unpacks items of depth and disparity streams. Keeps working memory; for one thread.
class DepthDecoder {
 public:
  // FAILED_PRECONDITION for an item of another kind or codec (reason NOT_DEPTH); DATA_LOSS for a
  // payload that does not fit its header.
  Result<DepthFrame> Decode(const visionserver::v1::StreamItem& item);

 private:
  template <class T>
  Result<void> Unpack(const std::string& packed, visionserver::v1::Codec codec,
                      std::vector<T>* pixels);

  wire::ZstdUnpacker zstd_;
  std::vector<uint8_t> rvl_;
};

}  // namespace vs::client
