#include "client/connection.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>

#include <fstream>

#include "client/client.h"
#include "client/socket.h"
#include "tests/client/certificates.h"
#include "tests/client/fake_server.h"
#include "tests/support/temp_folder.h"

namespace vs::client {
namespace {

using ::testing::HasSubstr;
using ::vs::test::CertificatePair;
using ::vs::test::FakeServer;
using ::vs::test::FingerprintOf;
using ::vs::test::MakeCertificate;

constexpr char kLocalNames[] = "DNS:localhost,IP:127.0.0.1";

// A port of this machine on which nobody listens, or somebody who never answers.
class DeafPort {
 public:
  explicit DeafPort(bool listens) : socket_(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t size = sizeof(address);
    EXPECT_EQ(::bind(socket_.fd(), reinterpret_cast<sockaddr*>(&address), size), 0);
    if (listens) ::listen(socket_.fd(), 16);
    ::getsockname(socket_.fd(), reinterpret_cast<sockaddr*>(&address), &size);
    address_ = "127.0.0.1:" + std::to_string(ntohs(address.sin_port));
  }
  const std::string& address() const { return address_; }

 private:
  Socket socket_;
  std::string address_;
};

class ConnectionTest : public testing::Test {
 protected:
  Error ErrorOf(const ConnectOptions& options) {
    const Result<std::unique_ptr<Client>> client = Client::Connect(options);
    return client ? Error{.code = Code::kUnknown, .message = "connected", .reason = "NONE"}
                  : client.error();
  }

  test::TempFolder folder_;
};

void ExpectWorks(const ConnectOptions& options) {
  const Result<std::unique_ptr<Client>> client = Client::Connect(options);
  ASSERT_TRUE(client) << client.error().ToString();
  const auto info = (*client)->ServerInfo();
  ASSERT_TRUE(info) << info.error().ToString();
  EXPECT_EQ("VisionServer", info->product());
}

TEST_F(ConnectionTest, TrustsACertificateByItsFile) {
  const CertificatePair own = MakeCertificate(folder_.path(), "server", kLocalNames);
  const FakeServer server(&own);
  ExpectWorks({.address = server.Address(), .ca_file = own.certificate});
}

TEST_F(ConnectionTest, TrustsACertificateByTheAuthorityThatSignedIt) {
  const CertificatePair authority = MakeCertificate(folder_.path(), "authority", "DNS:authority");
  const CertificatePair own = MakeCertificate(folder_.path(), "server", kLocalNames, &authority);
  const FakeServer server(&own);
  ExpectWorks({.address = server.Address(), .ca_file = authority.certificate});
}

TEST_F(ConnectionTest, TrustsACertificateByItsFingerprintWhateverItsNames) {
  const CertificatePair own = MakeCertificate(folder_.path(), "server", "DNS:elsewhere.example");
  const FakeServer server(&own);
  ExpectWorks({.address = server.Address(), .fingerprint = FingerprintOf(own.certificate)});
}

TEST_F(ConnectionTest, TrustsASignedCertificateByItsFingerprint) {
  const CertificatePair authority = MakeCertificate(folder_.path(), "authority", "DNS:authority");
  const CertificatePair own = MakeCertificate(folder_.path(), "server", kLocalNames, &authority);
  const FakeServer server(&own);
  ExpectWorks({.address = server.Address(), .fingerprint = FingerprintOf(own.certificate)});
}

TEST_F(ConnectionTest, RefusesAnotherCertificateThanThePinnedOne) {
  const CertificatePair own = MakeCertificate(folder_.path(), "server", kLocalNames);
  const CertificatePair other = MakeCertificate(folder_.path(), "other", kLocalNames);
  const FakeServer server(&other);
  const Error error =
      ErrorOf({.address = server.Address(), .fingerprint = FingerprintOf(own.certificate)});
  EXPECT_EQ("CERTIFICATE_MISMATCH", error.reason);
  EXPECT_EQ(Code::kUnavailable, error.code);
  EXPECT_THAT(error.message, HasSubstr(FingerprintOf(other.certificate)));
}

TEST_F(ConnectionTest, RefusesACertificateOfAnotherAuthorityAndShowsItsFingerprint) {
  const CertificatePair own = MakeCertificate(folder_.path(), "server", kLocalNames);
  const CertificatePair other = MakeCertificate(folder_.path(), "other", kLocalNames);
  const FakeServer server(&own);
  const Error error = ErrorOf({.address = server.Address(), .ca_file = other.certificate});
  EXPECT_EQ("CERTIFICATE_UNTRUSTED", error.reason);
  EXPECT_THAT(error.message, HasSubstr(FingerprintOf(own.certificate)));
}

TEST_F(ConnectionTest, RefusesACertificateThatTheSystemDoesNotKnow) {
  const CertificatePair own = MakeCertificate(folder_.path(), "server", kLocalNames);
  const FakeServer server(&own);
  EXPECT_EQ("CERTIFICATE_UNTRUSTED", ErrorOf({.address = server.Address()}).reason);
}

TEST_F(ConnectionTest, RefusesACertificateForAnotherHost) {
  const CertificatePair own = MakeCertificate(folder_.path(), "server", "DNS:elsewhere.example");
  const FakeServer server(&own);
  const Error error = ErrorOf({.address = server.Address(), .ca_file = own.certificate});
  EXPECT_EQ("CERTIFICATE_UNTRUSTED", error.reason);
  EXPECT_THAT(error.message, HasSubstr("it is for elsewhere.example, not for 127.0.0.1"));
}

TEST_F(ConnectionTest, SaysThatNobodyListens) {
  const DeafPort port(false);
  for (const bool plaintext : {false, true}) {
    const Error error = ErrorOf({.address = port.address(), .plaintext = plaintext});
    EXPECT_EQ(plaintext ? "CONNECTION_FAILED" : "CONNECTION_REFUSED", error.reason);
    EXPECT_EQ(Code::kUnavailable, error.code);
    EXPECT_THAT(error.message, HasSubstr(port.address()));
  }
}

TEST_F(ConnectionTest, SaysThatTheOtherSideSpeaksNoTls) {
  const FakeServer server;
  const std::string fingerprint(64, 'A');
  EXPECT_EQ("NO_TLS", ErrorOf({.address = server.Address()}).reason);
  EXPECT_EQ("NO_TLS", ErrorOf({.address = server.Address(), .fingerprint = fingerprint}).reason);
}

TEST_F(ConnectionTest, GivesUpOnAPortThatNeverAnswers) {
  const DeafPort port(true);
  const std::string fingerprint(64, 'A');
  const Error error = ErrorOf({.address = port.address(),
                               .fingerprint = fingerprint,
                               .connect_timeout = std::chrono::milliseconds(50)});
  EXPECT_EQ("CONNECTION_TIMEOUT", error.reason);
}

TEST_F(ConnectionTest, RefusesPlainTextBeyondThisMachine) {
  const Error error = ErrorOf({.address = "192.0.2.1", .plaintext = true});
  EXPECT_EQ(Code::kInvalidArgument, error.code);
  EXPECT_THAT(error.message, HasSubstr("TLS"));
}

TEST_F(ConnectionTest, RefusesOptionsThatMakeNoSense) {
  EXPECT_EQ(Code::kInvalidArgument, ErrorOf({.address = "cell:x"}).code);
  EXPECT_EQ(Code::kInvalidArgument, ErrorOf({.fingerprint = "AB:CD"}).code);
  EXPECT_EQ(Code::kInvalidArgument, ErrorOf({.ca_file = folder_ / "missing.crt"}).code);
  std::ofstream(folder_ / "empty.crt") << "no certificate\n";
  EXPECT_EQ(Code::kInvalidArgument, ErrorOf({.ca_file = folder_ / "empty.crt"}).code);
  EXPECT_EQ(Code::kInvalidArgument, ErrorOf({.ca_file = folder_.path()}).code);
}

TEST_F(ConnectionTest, ReadsTheServersClock) {
  const FakeServer server;
  const auto client = Client::Connect({.address = server.Address(), .plaintext = true});
  ASSERT_TRUE(client) << client.error().ToString();
  const Result<ServerClock> clock = (*client)->ReadServerClock();
  ASSERT_TRUE(clock) << clock.error().ToString();
  EXPECT_LE(std::abs(clock->offset_ns - 1'000'000'000'000), clock->uncertainty_ns);
}

TEST_F(ConnectionTest, SaysWhenTheConnectionIsLost) {
  auto server = std::make_unique<FakeServer>();
  const auto client = Client::Connect({.address = server->Address(), .plaintext = true});
  ASSERT_TRUE(client) << client.error().ToString();
  server.reset();
  const auto info = (*client)->ServerInfo();
  ASSERT_FALSE(info);
  EXPECT_EQ(Code::kUnavailable, info.error().code);
  EXPECT_THAT(info.error().message, HasSubstr("connection to the server is lost"));
}

TEST(Errors, CarryReasonAndFaultsOfTheServer) {
  v1::ErrorStatus details;
  v1::ErrorDetail detail;
  detail.set_reason("SEQUENCE_FAULTY");
  v1::Fault* fault = detail.add_faults();
  fault->set_subject("rectify.left");
  fault->set_message("is not connected");
  details.add_details()->PackFrom(detail);
  const Error error =
      ToError({grpc::INVALID_ARGUMENT, "1 fault in stereo_depth", details.SerializeAsString()});
  EXPECT_EQ(Code::kInvalidArgument, error.code);
  EXPECT_EQ("SEQUENCE_FAULTY", error.reason);
  EXPECT_EQ(
      "INVALID_ARGUMENT: 1 fault in stereo_depth\n"
      "  rectify.left: is not connected",
      error.ToString());
}

TEST(Errors, KeepTheirCodeWhenTheDetailsAreGarbage) {
  const Error error = ToError({grpc::NOT_FOUND, "no such camera", "\xff\xff garbage"});
  EXPECT_EQ("NOT_FOUND", error.reason);
  EXPECT_EQ("no such camera", error.message);
}

}  // namespace
}  // namespace vs::client
