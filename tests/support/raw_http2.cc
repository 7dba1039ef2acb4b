#include "tests/support/raw_http2.h"

namespace vs::test {
namespace {

constexpr uint8_t kData = 0x0;
constexpr uint8_t kHeaders = 0x1;
constexpr uint8_t kEndStream = 0x1;
constexpr uint8_t kEndHeaders = 0x4;

void AppendBigEndian(uint32_t value, int bytes, std::string* text) {
  for (int i = bytes - 1; i >= 0; --i) *text += static_cast<char>(value >> (8 * i));
}

// A string literal of HPACK (RFC 7541, 5.2) without Huffman's code.
void AppendLiteral(std::string_view value, std::string* text) {
  size_t rest = value.size();
  if (rest < 127) {
    *text += static_cast<char>(rest);
  } else {
    *text += static_cast<char>(127);
    for (rest -= 127; rest >= 128; rest /= 128) *text += static_cast<char>(rest % 128 + 128);
    *text += static_cast<char>(rest);
  }
  *text += value;
}

}  // namespace

std::string Http2Preface() {
  return "PRI * HTTP/2.0\r\n\r\nSM\r\n\r\n" + Http2Frame(0x4, 0, 0, "");
}

std::string Http2Frame(uint8_t type, uint8_t flags, uint32_t stream, std::string_view payload) {
  std::string frame;
  AppendBigEndian(static_cast<uint32_t>(payload.size()), 3, &frame);
  frame += static_cast<char>(type);
  frame += static_cast<char>(flags);
  AppendBigEndian(stream, 4, &frame);
  frame += payload;
  return frame;
}

std::string Http2Headers(uint32_t stream, const HeaderFields& fields) {
  std::string block;
  for (const auto& [name, value] : fields) {
    block += '\0';
    AppendLiteral(name, &block);
    AppendLiteral(value, &block);
  }
  return Http2Frame(kHeaders, kEndHeaders, stream, block);
}

HeaderFields GrpcFields(const std::string& method, const std::string& token) {
  HeaderFields fields = {{":method", "POST"}, {":scheme", "http"},
                         {":path", method},   {":authority", "localhost"},
                         {"te", "trailers"},  {"content-type", "application/grpc"}};
  if (!token.empty()) fields.emplace_back("authorization", "Bearer " + token);
  return fields;
}

std::string GrpcCall(uint32_t stream, const std::string& method, const std::string& token,
                     std::string_view request) {
  std::string message(1, '\0');  // not compressed
  AppendBigEndian(static_cast<uint32_t>(request.size()), 4, &message);
  message += request;
  return Http2Headers(stream, GrpcFields(method, token)) +
         Http2Frame(kData, kEndStream, stream, message);
}

}  // namespace vs::test
