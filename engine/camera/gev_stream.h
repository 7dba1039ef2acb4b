#pragma once

#include <arv.h>

#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "engine/base/recycler.h"
#include "engine/base/status.h"
#include "engine/camera/gev_glib.h"
#include "engine/image/image.h"

namespace vs {

struct GevStreamOptions {
  int buffers = 8;  // pictures that may be on their way or held downstream
  bool resend = true;
  int socket_buffer_bytes = 4 << 20;
};

// What came out of the stream.
struct GevPicture {
  enum class Kind {
    kWhole,       // a picture with all its pixels, perhaps a stale one
    kRecycled,    // a buffer that came back unfilled
    kIncomplete,  // packets were missing, or it was not 8-bit grey of the expected size
    kAborted,     // the stream was stopped meanwhile
  };
  Kind kind = Kind::kAborted;
  uint64_t frame_id = 0;      // 0 when unknown
  int64_t timestamp_ns = 0;   // by the camera's clock
  int64_t leader_age_ns = 0;  // since its first packet arrived
  std::string problem;        // in words, of an incomplete one
  GreyImage image;            // of a whole one; the buffer returns to the stream with its last copy
};

struct GevStreamCounters {
  uint64_t underruns = 0;  // packets for which no buffer was free
  uint64_t resend_requests = 0;
  uint64_t resent = 0;
};

// The pictures of an open, configured camera: a UDP socket and a thread of Aravis that fills our
// buffers without another copy. Made, used and destroyed by the device thread; pictures may outlive
// it. Destroying it talks to the camera, which takes seconds when the camera is gone.
class GevStream {
 public:
  // Has memory for `options.buffers` pictures of the camera's present size.
  static Result<std::unique_ptr<GevStream>> Make(ArvDevice* device,
                                                 const GevStreamOptions& options);
  ~GevStream();
  GevStream(const GevStream&) = delete;
  GevStream& operator=(const GevStream&) = delete;

  // The next one that came; nullopt after `timeout`.
  std::optional<GevPicture> Pop(std::chrono::milliseconds timeout);

  GevStreamCounters Counters() const;
  // Payload bytes for which the system granted socket memory, 0 when it cannot be told. Right once
  // the first packet came.
  int SocketBufferBytes() const;
  int64_t payload_bytes() const { return payload_bytes_; }

 private:
  class ReturnPath;

  GevStream(ArvStream* stream, int64_t payload_bytes);
  GreyImage Wrap(ArvBuffer* buffer);

  GObjectPtr<ArvStream> stream_;
  const int64_t payload_bytes_;
  std::shared_ptr<ReturnPath> return_path_;
  Recycler<std::byte> control_blocks_;
};

}  // namespace vs
