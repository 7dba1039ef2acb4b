#pragma once

#include <chrono>
#include <string>
#include <string_view>
#include <vector>

#include "client/address.h"
#include "client/error.h"

namespace vs::client {

// What a server shows of itself when a TLS connection begins.
struct ServerCertificate {
  std::string pem;
  std::string fingerprint;         // SHA-256, "AB:CD:..."
  std::vector<std::string> names;  // that it is for: DNS names first, then IP addresses
  // Why the given authorities do not trust it for the given host, in words; empty when they do.
  std::string distrust;
};

// Connects, reads the certificate and disconnects. `roots_pem` are the authorities that `distrust`
// is about. All errors are UNAVAILABLE; the reason is one of HOST_NOT_FOUND, CONNECTION_REFUSED,
// CONNECTION_FAILED, CONNECTION_TIMEOUT, NO_TLS.
Result<ServerCertificate> FetchCertificate(const Address& address, const std::string& roots_pem,
                                           std::chrono::milliseconds timeout);

// Upper case with colons. INVALID_ARGUMENT unless there are 64 hexadecimal digits.
Result<std::string> NormalizeFingerprint(std::string_view text);

// The certificates of `ca_file`, or those of the system's authorities if it is empty.
// INVALID_ARGUMENT when the file cannot be read or holds no certificate.
Result<std::string> ReadRoots(const std::string& ca_file);

}  // namespace vs::client
