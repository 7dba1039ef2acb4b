#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "engine/base/status.h"

namespace vs {

// A server's certificate (PEM, perhaps with its chain) and private key (PEM).
struct CertificateFiles {
  std::filesystem::path certificate;
  std::filesystem::path key;
};

struct CertificateInfo {
  // SHA-256 over the certificate, as openssl and browsers show it: "AB:CD:...".
  std::string fingerprint;
  int64_t not_after_utc_ns = 0;
};

// The files "server.crt" and "server.key" in `folder` (made if necessary). When there are none,
// makes a self-signed certificate for this machine's names and addresses: EC P-256, ten years, the
// key readable by its owner only. Clients trust it by the file or by its fingerprint.
Result<CertificateFiles> EnsureCertificate(const std::filesystem::path& folder);

// Reads a certificate and its key. FAILED_PRECONDITION names the file that cannot be read, and says
// so when the two do not belong together.
Result<CertificateInfo> CheckCertificate(const CertificateFiles& files);

// "localhost", the machine's own names, and the addresses of its network interfaces.
std::vector<std::string> LocalNames();

}  // namespace vs
