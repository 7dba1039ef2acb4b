#include "proto/wire/decode_error.h"

namespace vs::wire {

std::string_view DecodeErrorText(DecodeError error) {
  switch (error) {
    case DecodeError::kNone:
      return "no error";
    case DecodeError::kTruncated:
      return "the packed bytes end before the last pixel or within a number";
    case DecodeError::kTrailingBytes:
      return "bytes follow the last pixel";
    case DecodeError::kBadRun:
      return "a run is empty or longer than the pixels that are left";
    case DecodeError::kValueOutOfRange:
      return "a pixel value does not fit its type";
    case DecodeError::kBadZstdFrame:
      return "not exactly one zstd frame that states its size";
    case DecodeError::kTooLarge:
      return "the packed bytes unpack to more than the image needs";
  }
  return "unknown error";
}

}  // namespace vs::wire
