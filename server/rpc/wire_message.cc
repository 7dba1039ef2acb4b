#include "server/rpc/wire_message.h"

#include <google/protobuf/message_lite.h>

#include <utility>

namespace vs {

WireSlice ToSlice(std::string bytes) {
  auto owner = std::make_shared<const std::string>(std::move(bytes));
  return {.data = owner->data(), .size_bytes = owner->size(), .owner = owner};
}

WireMessage Serialize(const google::protobuf::MessageLite& message) {
  return {ToSlice(message.SerializeAsString())};
}

size_t SizeBytes(const WireMessage& message) {
  size_t size_bytes = 0;
  for (const WireSlice& slice : message) size_bytes += slice.size_bytes;
  return size_bytes;
}

}  // namespace vs
