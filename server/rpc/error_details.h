#pragma once

#include <string>

#include "engine/base/status.h"

namespace vs {

// An error as it goes over the wire: the message, and a serialised visionserver.v1.ErrorStatus for
// the trailer `grpc-status-details-bin`. Both are cut to what every client takes: trailers beyond
// 8 kB break the whole call at the client.
struct WireError {
  std::string message;
  std::string details;
};
WireError ToWireError(const Status& status);

// UTF-8 text of at most so many bytes (3 or more), with "..." at its end when it was longer.
std::string CutTo(const std::string& text, size_t max_bytes);

}  // namespace vs
