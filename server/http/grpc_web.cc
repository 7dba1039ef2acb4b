#include "server/http/grpc_web.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cstdint>

#include "engine/base/str.h"
#include "server/rpc/error_details.h"

namespace vs {
namespace {

constexpr size_t kPrefixBytes = 5;
constexpr unsigned kCompressed = 0x01;
constexpr unsigned kTrailers = 0x80;

std::string Prefix(unsigned flags, size_t size_bytes) {
  std::string prefix(1, static_cast<char>(flags));
  for (const int shift : {24, 16, 8, 0}) {
    prefix += static_cast<char>((size_bytes >> shift) & 0xffU);
  }
  return prefix;
}

// As gRPC wants `grpc-message`: UTF-8 and what could end the line as %XX.
std::string PercentEncode(std::string_view text) {
  static constexpr std::string_view kDigits = "0123456789ABCDEF";
  std::string encoded;
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (byte >= 0x20 && byte <= 0x7e && c != '%') {
      encoded += c;
    } else {
      encoded += {'%', kDigits[byte >> 4U], kDigits[byte & 15U]};
    }
  }
  return encoded;
}

std::string Base64(std::string_view bytes) {
  static constexpr std::string_view kDigits =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  uint32_t bits = 0;
  unsigned count = 0;
  for (const char c : bytes) {
    bits = (bits << 8U) | static_cast<unsigned char>(c);
    for (count += 8; count >= 6; count -= 6) text += kDigits[(bits >> (count - 6)) & 63U];
  }
  if (count > 0) text += kDigits[(bits << (6 - count)) & 63U];
  while (text.size() % 4 != 0) text += '=';
  return text;
}

}  // namespace

bool IsGrpcWebType(std::string_view content_type) {
  content_type = content_type.substr(0, content_type.find_first_of("; "));
  return content_type == kGrpcWebType || content_type == "application/grpc-web";
}

Result<std::string> MessageOf(std::string body) {
  if (body.size() < kPrefixBytes) {
    return InvalidArgument(Str("the request has ", body.size(),
                               " bytes: a gRPC-Web request is one frame, with a prefix of 5"));
  }
  const auto byte = [&](size_t i) { return static_cast<unsigned char>(body[i]); };
  if (byte(0) == kCompressed) {
    return Unimplemented("compressed messages are not taken; send them as they are");
  }
  if (byte(0) != 0) {
    return InvalidArgument(
        Str("the request's frame has the flags ", int{byte(0)}, "; a message has 0"));
  }
  const uint64_t size = (uint64_t{byte(1)} << 24U) | (byte(2) << 16U) | (byte(3) << 8U) | byte(4);
  if (size != body.size() - kPrefixBytes) {
    return InvalidArgument(Str("the request's frame announces ", size, " bytes and ",
                               body.size() - kPrefixBytes, " follow: send one frame"));
  }
  body.erase(0, kPrefixBytes);
  return body;
}

std::string MessagePrefix(size_t size_bytes) { return Prefix(0, size_bytes); }

std::string TrailerFrame(const Status& status) {
  std::string trailers = Str("grpc-status: ", static_cast<int>(status.code()), "\r\n");
  if (!status.ok()) {
    const WireError error = ToWireError(status);
    trailers += "grpc-message: " + PercentEncode(error.message) + "\r\n";
    trailers += "grpc-status-details-bin: " + Base64(error.details) + "\r\n";
  }
  return Prefix(kTrailers, trailers.size()) + trailers;
}

Result<std::optional<std::chrono::nanoseconds>> ParseTimeout(std::string_view text) {
  using std::chrono::nanoseconds;
  if (text.empty()) return std::nullopt;
  static constexpr std::string_view kUnits = "HMSmun";
  static constexpr std::array<int64_t, 6> kUnitNs = {
      3'600'000'000'000, 60'000'000'000, 1'000'000'000, 1'000'000, 1'000, 1};
  const size_t unit = kUnits.find(text.back());
  int64_t count = 0;
  const char* end = text.data() + text.size() - 1;
  const auto parsed = std::from_chars(text.data(), end, count);
  if (unit == std::string_view::npos || text.size() < 2 || text.size() > 9 || parsed.ptr != end ||
      parsed.ec != std::errc() || count < 0) {
    return InvalidArgument(Str("grpc-timeout is ", Quoted(text),
                               "; it must be at most 8 digits and a unit of H, M, S, m, u or n"));
  }
  // The longest count of hours would not fit; nobody tells it from a month.
  static constexpr int64_t kLongestNs = int64_t{30} * 24 * kUnitNs[0];
  return nanoseconds(std::min(count, kLongestNs / kUnitNs[unit]) * kUnitNs[unit]);
}

}  // namespace vs
