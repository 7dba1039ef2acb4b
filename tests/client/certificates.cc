#include "tests/client/certificates.h"

#include <gtest/gtest.h>

#include <fstream>
#include <iterator>

#include "tests/support/child_process.h"

namespace vs::test {
namespace {

std::string OpenSsl(std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), "openssl");
  const Result<FinishedProcess> done = RunProcess(arguments);
  EXPECT_TRUE(done && done->exit_code == 0)
      << (done ? done->error_output : done.error().ToString());
  return done ? done->output : "";
}

}  // namespace

CertificatePair MakeCertificate(const std::filesystem::path& folder, const std::string& name,
                                const std::string& names, const CertificatePair* issuer) {
  CertificatePair made{.certificate = folder / (name + ".crt"), .key = folder / (name + ".key")};
  std::vector<std::string> arguments = {"req",
                                        "-x509",
                                        "-newkey",
                                        "ec",
                                        "-pkeyopt",
                                        "ec_paramgen_curve:P-256",
                                        "-nodes",
                                        "-days",
                                        "30",
                                        "-subj",
                                        "/CN=" + name,
                                        "-keyout",
                                        made.key,
                                        "-out",
                                        made.certificate,
                                        "-addext",
                                        "subjectAltName=" + names};
  if (issuer != nullptr) {
    arguments.insert(arguments.end(), {"-CA", issuer->certificate, "-CAkey", issuer->key, "-addext",
                                       "basicConstraints=critical,CA:FALSE"});
  }
  OpenSsl(arguments);
  return made;
}

std::string ReadFile(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

std::string FingerprintOf(const std::filesystem::path& certificate) {
  const std::string line =
      OpenSsl({"x509", "-noout", "-fingerprint", "-sha256", "-in", certificate});
  const std::string digits = line.substr(line.find('=') + 1);
  return digits.substr(0, digits.find('\n'));
}

}  // namespace vs::test
