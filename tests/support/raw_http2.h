#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace vs::test {

// The bytes of HTTP/2 (RFC 9113) and gRPC, for clients that keep to no rules: they are sent through
// a RawSocket, and nobody reads or acknowledges anything unless the test does.

using HeaderFields = std::vector<std::pair<std::string, std::string>>;

// The client's preface with an empty SETTINGS frame.
std::string Http2Preface();
// At most 16,384 bytes of payload.
std::string Http2Frame(uint8_t type, uint8_t flags, uint32_t stream, std::string_view payload);
// A whole HEADERS frame; `fields` are sent as they are (HPACK literals without indexing).
std::string Http2Headers(uint32_t stream, const HeaderFields& fields);
// The header fields of a gRPC call; without `authorization` when `token` is empty.
HeaderFields GrpcFields(const std::string& method, const std::string& token);
// A whole gRPC call with its one request.
std::string GrpcCall(uint32_t stream, const std::string& method, const std::string& token,
                     std::string_view request);

}  // namespace vs::test
