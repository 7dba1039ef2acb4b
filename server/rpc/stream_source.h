#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <utility>

#include "engine/base/status.h"
#include "server/rpc/wire_message.h"

namespace vs {

// What an open stream does next: sends a message, waits, or ends.
struct StreamStep {
  enum class Kind { kMessage, kWait, kEnd };

  static StreamStep Message(WireMessage message) {
    return {.kind = Kind::kMessage, .message = std::move(message)};
  }
  // Until the source wakes, or until this instant of the host's monotonic clock.
  static StreamStep Wait(std::optional<int64_t> until_ns = std::nullopt) {
    return {.kind = Kind::kWait, .until_ns = until_ns};
  }
  static StreamStep End(Status status = Status()) {
    return {.kind = Kind::kEnd, .status = std::move(status)};
  }

  Kind kind = Kind::kWait;
  WireMessage message;
  std::optional<int64_t> until_ns;
  Status status;
};

// What one open server stream has to say. It is asked for the next message only when the one before
// has gone out, so a slow client never makes a queue: a source keeps the newest, not all.
//
// Start and Next are called on worker threads, one call at a time. The source goes (on any thread)
// when the stream has ended, for whatever reason: the client left, its session was revoked, it did
// not read, the server shuts down.
class StreamSource {
 public:
  virtual ~StreamSource() = default;

  // Before the first Next. `wake` asks for Next again after it said Wait; it may be called from any
  // thread at any time, also after the stream has ended, and only takes note.
  virtual void Start(std::function<void()> /*wake*/) {}  // NOLINT(performance-*): kept by some
  virtual StreamStep Next() = 0;
};

}  // namespace vs
