#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

namespace google::protobuf {
class MessageLite;
}

namespace vs {

// Bytes that are sent as they are. Whoever sends them keeps a copy of `owner` meanwhile, so one
// payload serves any number of calls without being copied.
struct WireSlice {
  const void* data = nullptr;
  size_t size_bytes = 0;
  std::shared_ptr<const void> owner;
};

// A serialised protobuf message in pieces, in order.
using WireMessage = std::vector<WireSlice>;

WireSlice ToSlice(std::string bytes);
WireMessage Serialize(const google::protobuf::MessageLite& message);
size_t SizeBytes(const WireMessage& message);

}  // namespace vs
