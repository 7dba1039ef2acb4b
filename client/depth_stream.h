#pragma once

#include <utility>

#include "client/decode_depth.h"
#include "client/depth_frame.h"
#include "client/latest_stream.h"

namespace vs::client {

// The newest depth image of a running sequence: a LatestStream whose items are unpacked when they
// are taken. One thread at a time may call Next.
class DepthStream {
 public:
  explicit DepthStream(LatestStream items) : items_(std::move(items)) {}

  // As LatestStream::Next; and FAILED_PRECONDITION (reason NOT_DEPTH) when the stream holds
  // something else.
  Result<DepthFrame> Next(std::chrono::milliseconds timeout) {
    const auto item = items_.Next(timeout);
    if (!item) return tl::unexpected(item.error());
    return decoder_.Decode(*item);
  }

  StreamStats stats() const { return items_.stats(); }

 private:
  LatestStream items_;
  DepthDecoder decoder_;
};

}  // namespace vs::client
