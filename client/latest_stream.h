#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <string>

#include "visionserver/v1/stream.pb.h"

#include "client/error.h"

namespace vs::client {

class Connection;

struct StreamOptions {
  // CODEC_UNSPECIFIED: what the server thinks best, RVL for maps and JPEG for pictures.
  visionserver::v1::Codec codec = visionserver::v1::CODEC_UNSPECIFIED;
  // Items under way at once, 1..16. 2 suits a local network; 1 is the smallest delay for a thin
  // line; more for one of long round trips.
  uint32_t window = 2;
  double max_fps = 0;  // 0: as they come
  bool confidence = false;
  bool reasons = false;
  uint32_t jpeg_quality = 80;  // 1..100
  // Items are received and replaced all the time, so that Next answers with the newest there is.
  // True: only as many as `window` are fetched before Next takes one. Saves the line when Next is
  // called seldom, but what it returns is then nearly as old as the time between two calls.
  bool pause_while_unread = false;
};

struct StreamStats {
  uint64_t items = 0;    // received
  uint64_t bytes = 0;    // of them, as they were sent
  uint64_t dropped = 0;  // passed over by the server, because this client or the line was busy
  uint64_t skipped = 0;  // received, but replaced by a newer one before Next took them
  uint64_t reconnects = 0;
};

// The newest item of one stream of a running sequence. A thread of its own receives, so a caller
// that takes its time never gets an old item; opens the stream again when the connection is lost.
// One thread at a time may call Next.
class LatestStream {
 public:
  // `stream` is a StreamInfo.stream such as "stereo_depth/depth"; it need not be there yet.
  LatestStream(const std::shared_ptr<Connection>& connection, std::string stream,
               StreamOptions options);
  ~LatestStream();
  LatestStream(LatestStream&&) noexcept;
  LatestStream& operator=(LatestStream&&) noexcept;

  // The newest item that was not returned before; waits for it. `dropped` of the item counts what
  // this subscription passed over since the item that Next returned before, wherever that was.
  // DEADLINE_EXCEEDED says what is known about why none came; call again whenever you like. Errors
  // that waiting does not mend (UNAUTHENTICATED, PERMISSION_DENIED ...) come at once, every time.
  Result<visionserver::v1::StreamItem> Next(std::chrono::milliseconds timeout);

  StreamStats stats() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace vs::client
