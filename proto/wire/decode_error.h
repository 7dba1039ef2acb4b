#pragma once

#include <string_view>

namespace vs::wire {

// What is wrong with packed bytes that came from elsewhere.
enum class DecodeError {
  kNone,
  kTruncated,        // the bytes end before the last pixel, or a number has no end
  kTrailingBytes,    // bytes follow the last pixel
  kBadRun,           // a run is empty or longer than the pixels that are left
  kValueOutOfRange,  // a pixel would not fit its type
  kBadZstdFrame,     // not exactly one zstd frame that states its size
  kTooLarge,         // would unpack to more than the receiver allows
};

// The same in words for people.
std::string_view DecodeErrorText(DecodeError error);

}  // namespace vs::wire
