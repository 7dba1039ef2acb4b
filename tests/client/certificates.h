#pragma once

#include <filesystem>
#include <string>

namespace vs::test {

struct CertificatePair {
  std::filesystem::path certificate;
  std::filesystem::path key;
};

// A new certificate and key as `folder`/NAME.crt and NAME.key, for the hosts in `names`, such as
// "DNS:localhost,IP:127.0.0.1". Signed by `issuer` if there is one, else by itself.
CertificatePair MakeCertificate(const std::filesystem::path& folder, const std::string& name,
                                const std::string& names, const CertificatePair* issuer = nullptr);

// The content of a file.
std::string ReadFile(const std::filesystem::path& path);

// "AB:CD:..." as the openssl program prints it.
std::string FingerprintOf(const std::filesystem::path& certificate);

}  // namespace vs::test
