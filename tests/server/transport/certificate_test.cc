#include "server/transport/certificate.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "tests/support/child_process.h"
#include "tests/support/temp_folder.h"

namespace vs {
namespace {

using std::filesystem::perms;
using ::testing::HasSubstr;

std::string OpenSsl(const std::vector<std::string>& arguments) {
  std::vector<std::string> command = {"openssl"};
  command.insert(command.end(), arguments.begin(), arguments.end());
  const auto result = test::RunProcess(command);
  EXPECT_TRUE(result.has_value());
  return result ? result->output : "";
}

TEST(Certificate, IsMadeOnceForThisMachine) {
  const test::TempFolder folder;
  const CertificateFiles files = *EnsureCertificate(folder / "tls");
  EXPECT_EQ(std::filesystem::status(files.key).permissions(),
            perms::owner_read | perms::owner_write);
  const std::string text = OpenSsl({"x509", "-in", files.certificate.string(), "-noout", "-text"});
  EXPECT_THAT(text, HasSubstr("DNS:localhost"));
  EXPECT_THAT(text, HasSubstr("IP Address:127.0.0.1"));
  EXPECT_THAT(text, HasSubstr("prime256v1"));
  EXPECT_THAT(text, HasSubstr("TLS Web Server Authentication"));
  EXPECT_THAT(text, HasSubstr("CA:FALSE"));

  const std::string fingerprint = CheckCertificate(files)->fingerprint;
  const CertificateFiles again = *EnsureCertificate(folder / "tls");
  EXPECT_EQ(CheckCertificate(again)->fingerprint, fingerprint);
}

TEST(Certificate, FingerprintIsTheOneThatOpenSslShows) {
  const test::TempFolder folder;
  const CertificateFiles files = *EnsureCertificate(folder.path());
  EXPECT_THAT(
      OpenSsl({"x509", "-in", files.certificate.string(), "-noout", "-fingerprint", "-sha256"}),
      HasSubstr(CheckCertificate(files)->fingerprint));
}

TEST(Certificate, LastsForTenYears) {
  const test::TempFolder folder;
  const CertificateInfo info = *CheckCertificate(*EnsureCertificate(folder.path()));
  const auto left = std::chrono::nanoseconds(info.not_after_utc_ns) -
                    std::chrono::system_clock::now().time_since_epoch();
  EXPECT_NEAR(std::chrono::duration_cast<std::chrono::hours>(left).count(), 3650 * 24, 24);
}

TEST(Certificate, KeyLeftAloneByACrashGetsANewCertificate) {
  const test::TempFolder folder;
  const CertificateFiles files = *EnsureCertificate(folder.path());
  std::filesystem::remove(files.certificate);
  ASSERT_TRUE(EnsureCertificate(folder.path()).has_value());
  EXPECT_TRUE(CheckCertificate(files).has_value());
}

TEST(Certificate, CertificateWithoutItsKeyIsNotReplaced) {
  const test::TempFolder folder;
  const CertificateFiles files = *EnsureCertificate(folder.path());
  std::filesystem::remove(files.key);
  EXPECT_THAT(EnsureCertificate(folder.path()).error().message(), HasSubstr("has no key"));
}

TEST(Certificate, SaysWhatIsWrongWithTheFiles) {
  const test::TempFolder folder;
  const CertificateFiles one = *EnsureCertificate(folder / "one");
  const CertificateFiles two = *EnsureCertificate(folder / "two");
  const auto message = [](const CertificateFiles& files) {
    return CheckCertificate(files).error().message();
  };
  EXPECT_THAT(message({.certificate = one.certificate, .key = two.key}),
              HasSubstr("is not the key of"));
  EXPECT_THAT(message({.certificate = folder / "none.crt", .key = one.key}),
              HasSubstr("No such file"));
  EXPECT_THAT(message({.certificate = one.certificate, .key = folder / "none.key"}),
              HasSubstr("No such file"));
  std::ofstream(folder / "garbage") << "garbage";
  EXPECT_THAT(message({.certificate = folder / "garbage", .key = one.key}),
              HasSubstr("holds no certificate"));
  EXPECT_THAT(message({.certificate = one.certificate, .key = folder / "garbage"}),
              HasSubstr("holds no private key"));
}

}  // namespace
}  // namespace vs
