#pragma once

#include <chrono>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

#include "engine/base/status.h"

namespace vs {

// gRPC-Web (PROTOCOL-WEB.md of gRPC): a body is a row of frames, each with a flag byte and a length
// of four; the last one of an answer holds the trailers as text.

inline constexpr std::string_view kGrpcWebType = "application/grpc-web+proto";

// Whether a Content-Type is the binary form of gRPC-Web with protobuf messages.
bool IsGrpcWebType(std::string_view content_type);

// The message in the body of a request, which has exactly one. INVALID_ARGUMENT, or UNIMPLEMENTED
// for a compressed message.
Result<std::string> MessageOf(std::string body);

// What precedes a message of `size_bytes` in the body of an answer.
std::string MessagePrefix(size_t size_bytes);
// The frame that ends an answer.
std::string TrailerFrame(const Status& status);

// "100m" is 100 milliseconds; nothing when `text` is empty. INVALID_ARGUMENT.
Result<std::optional<std::chrono::nanoseconds>> ParseTimeout(std::string_view text);

}  // namespace vs
