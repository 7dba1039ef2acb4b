// What strangers may do to the port, and what it costs the others.

#include "server/transport/grpc_server.h"

#include <gmock/gmock.h>
#include <grpcpp/grpcpp.h>
#include <gtest/gtest.h>

#include <fstream>
#include <random>

#include "visionserver/v1/result.pb.h"
#include "visionserver/v1/session.grpc.pb.h"
#include "visionserver/v1/system.grpc.pb.h"

#include "engine/base/str.h"
#include "tests/support/child_process.h"
#include "tests/support/client_call.h"
#include "tests/support/raw_call.h"
#include "tests/support/raw_http2.h"
#include "tests/support/raw_socket.h"
#include "tests/support/test_server.h"
#include "tests/support/wait_until.h"

namespace vs {
namespace {

namespace pb = visionserver::v1;
using test::CallRaw;
using test::ClientCall;
using test::RawSocket;
using test::TestServer;
using test::WaitUntil;
using ::testing::AnyOf;
using ::testing::HasSubstr;

constexpr const char* kInfo = "/visionserver.v1.SystemService/GetServerInfo";
constexpr const char* kListUsers = "/visionserver.v1.UserService/ListUsers";
// How an HTTP/2 connection begins, with an empty SETTINGS frame.
const std::string kPreface =
    std::string("PRI * HTTP/2.0\r\n\r\nSM\r\n\r\n") + std::string("\0\0\0\4\0\0\0\0\0", 9);

bool Serves(TestServer& server) { return CallRaw(server.Connect(), kInfo, "").status.ok(); }

TEST(GrpcServer, SurvivesGarbageOnItsPort) {
  TestServer server;
  const std::shared_ptr<grpc::Channel> client = server.Connect();
  std::mt19937 random(11);
  std::vector<std::string> garbage = {
      "GET / HTTP/1.1\r\nHost: x\r\n\r\n",
      std::string("\x16\x03\x01\x02\x00\x01\x00\x01\xfc\x03\x03", 11),  // TLS where there is none
      "PRI * HTTP/2.0\r\n\r\nXX\r\n\r\n",
      std::string(100'000, '\0'),
      kPreface + std::string("\xff\xff\xff\x01\x04\0\0\0\1", 9),             // a frame of 16 MB
      kPreface + std::string("\0\0\4\x01\x04\0\0\0\1\xff\xff\xff\xff", 13),  // no HPACK
      kPreface + std::string("\0\0\5\0\0\0\0\0\7hello", 14)};                // DATA for no stream
  for (int i = 0; i < 60; ++i) {
    std::string bytes(1 + random() % 2000, '\0');
    for (char& byte : bytes) byte = static_cast<char>(random());
    garbage.push_back(i % 2 == 0 ? bytes : kPreface + bytes);
  }
  for (const std::string& bytes : garbage) {
    RawSocket socket(server->port());
    socket.Send(bytes);
    EXPECT_TRUE(CallRaw(client, kInfo, "").status.ok());
  }
  EXPECT_TRUE(Serves(server));
}

TEST(GrpcServer, ClosesConnectionsThatNeverBegin) {
  TestServer server({.config = "limits { handshake_ms: 500 }"});
  RawSocket silent(server->port());
  RawSocket half(server->port());
  half.Send("PRI * HTTP/2.0\r\n");
  EXPECT_TRUE(silent.WaitForClose());
  EXPECT_TRUE(half.WaitForClose());
  EXPECT_TRUE(WaitUntil([&] { return server->grpc().Connections().open == 0; }));
}

TEST(GrpcServer, ClosesTlsConnectionsThatNeverFinishTheirHandshake) {
  TestServer server({.tls = true, .config = "limits { handshake_ms: 500 }"});
  RawSocket silent(server->port());
  RawSocket half(server->port());
  half.Send(std::string("\x16\x03\x01\x02\x00\x01\x00\x01\xfc\x03\x03", 11));
  EXPECT_TRUE(silent.WaitForClose());
  EXPECT_TRUE(half.WaitForClose());
  EXPECT_TRUE(Serves(server));
}

TEST(GrpcServer, KeepsToItsLimitOfConnections) {
  TestServer server({.config = "limits { connections_per_address: 3 }"});
  std::vector<RawSocket> sockets;
  for (int i = 0; i < 3; ++i) sockets.emplace_back(server->port());
  EXPECT_TRUE(WaitUntil([&] { return server->grpc().Connections().accepted == 3; }));
  RawSocket surplus(server->port());
  EXPECT_TRUE(surplus.WaitForClose());
  EXPECT_EQ(server->grpc().Connections().refused, 1U);
  sockets.clear();
  EXPECT_TRUE(WaitUntil([&] { return server->grpc().Connections().open == 0; }));
  EXPECT_TRUE(Serves(server));
}

TEST(GrpcServer, RefusesAMessageOverTheLimitAndKeepsTheConnection) {
  TestServer server;
  const std::shared_ptr<grpc::Channel> client = server.Connect();
  const std::string token = server.Token(Role::kAdmin);
  const std::string oversize((4 << 20) + 1, '\0');
  EXPECT_EQ(CallRaw(client, kListUsers, token, oversize).status.error_code(),
            grpc::StatusCode::RESOURCE_EXHAUSTED);
  EXPECT_TRUE(CallRaw(client, kListUsers, token).status.ok());
  EXPECT_EQ(server->grpc().Connections().accepted, 1U);
}

TEST(GrpcServer, RefusesMetadataOverTheLimit) {
  TestServer server;
  // A client that has heard of the limit already does not even send it; on another the server hangs
  // up.
  EXPECT_THAT(CallRaw(server.Connect(), kListUsers, std::string(9000, 'x')).status.error_code(),
              AnyOf(grpc::StatusCode::RESOURCE_EXHAUSTED, grpc::StatusCode::UNAVAILABLE));
  EXPECT_TRUE(Serves(server));
}

// CVE-2023-1428: gRPC before 1.53 could be made to abort like this.
TEST(GrpcServer, SurvivesAWrongHeaderTogetherWithTooManyOthers) {
  TestServer server;
  for (const auto& wrong : test::HeaderFields{
           {"te", "x"}, {":scheme", "x"}, {"grpclb_client_stats", "x"}, {"grpc-timeout", "x"}}) {
    test::HeaderFields fields = test::GrpcFields(kInfo, "");
    std::erase_if(fields, [&](const auto& field) { return field.first == wrong.first; });
    // Those of HTTP/2 itself go before the others.
    fields.insert(wrong.first.starts_with(':') ? fields.begin() : fields.end(), wrong);
    fields.emplace_back("x-much", std::string(9'000, 'x'));
    RawSocket socket(server->port());
    socket.Send(test::Http2Preface() + test::Http2Headers(1, fields));
    EXPECT_TRUE(Serves(server)) << wrong.first;
  }
}

TEST(GrpcServer, CutsOffAClientThatDoesNotReadItsAnswer) {
  TestServer server({.config = "limits { unread_ms: 500 keepalive_ms: 3600000 }"});
  constexpr const char* kQuery = "/visionserver.v1.ResultService/QueryResults";
  pb::QueryResultsRequest large;
  large.set_sql("SELECT hex(zeroblob(100000))");
  RawSocket client(server->port());
  client.Send(test::Http2Preface() +
              test::GrpcCall(1, kQuery, server.Token(Role::kViewer), large.SerializeAsString()));
  // It is answered, with more than goes out at once; the call is not over before the client reads.
  ASSERT_TRUE(WaitUntil([&] {
    const std::vector<MethodStats> methods = server->dispatcher().Statistics();
    return methods.size() == 1 && methods[0].method == kQuery && methods[0].succeeded == 1;
  }));
  EXPECT_FALSE(server->dispatcher().Idle());
  EXPECT_TRUE(WaitUntil([&] { return server->dispatcher().Idle(); }));
}

TEST(GrpcServer, DropsAPeerThatShowsNoSignOfLife) {
  TestServer server({.config = "limits { keepalive_ms: 1000 unread_ms: 600000 }"});
  RawSocket peer(server->port());
  peer.Send(test::Http2Preface() +
            test::GrpcCall(1, "/grpc.health.v1.Health/Watch", server.Token(Role::kViewer), ""));
  ASSERT_TRUE(WaitUntil([&] { return server->dispatcher().OpenStreams() == 1; }));
  EXPECT_TRUE(WaitUntil([&] { return server->dispatcher().OpenStreams() == 0; }));
  EXPECT_TRUE(peer.WaitForClose());
}

TEST(GrpcServer, BearsThatItsClientsAskForASignOfLifeEveryTenSeconds) {
  using std::chrono::milliseconds;
  EXPECT_EQ(ShortestPingInterval(milliseconds(1'000)), milliseconds(500));
  EXPECT_EQ(ShortestPingInterval(milliseconds(10'000)), milliseconds(5'000));
  EXPECT_EQ(ShortestPingInterval(milliseconds(3'600'000)), milliseconds(5'000));
}

TEST(GrpcServer, UnpacksNoCompressedMessages) {
  TestServer server;
  const auto stub = pb::SessionService::NewStub(server.Connect());
  ClientCall call("");
  call.context()->set_compression_algorithm(GRPC_COMPRESS_GZIP);
  pb::LoginRequest request;
  request.set_password(std::string(1'000'000, 'p'));
  pb::LoginResponse response;
  EXPECT_EQ(stub->Login(call.context(), request, &response).error_code(),
            grpc::StatusCode::UNIMPLEMENTED);
}

TEST(GrpcServer, MalformedRequestIsAnsweredAsOne) {
  TestServer server;
  EXPECT_EQ(CallRaw(server.Connect(), "/visionserver.v1.SessionService/Login", "", "\x0a\x7f")
                .status.error_code(),
            grpc::StatusCode::INVALID_ARGUMENT);
  // Also of a stream.
  EXPECT_EQ(CallRaw(server.Connect(), "/grpc.health.v1.Health/Watch", server.Token(Role::kViewer),
                    "\x0a\x7f")
                .status.error_code(),
            grpc::StatusCode::INVALID_ARGUMENT);
}

TEST(GrpcServer, KnowsItsClientsAddressAndBelievesNoOther) {
  TestServer server;
  const std::string token = server.Token(Role::kViewer);
  const auto address_seen = [&](const std::shared_ptr<grpc::Channel>& channel) {
    ClientCall login("");
    login.context()->AddMetadata("x-vs-client-address", "10.9.8.7");
    pb::LoginRequest request;
    request.set_user("test.viewer");
    request.set_password(TestServer::kPassword);
    pb::LoginResponse response;
    EXPECT_TRUE(
        pb::SessionService::NewStub(channel)->Login(login.context(), request, &response).ok());
    for (const SessionInfo& session : server->access().sessions().List("test.viewer")) {
      if (session.record.id == response.session_id()) return session.record.address;
    }
    return std::string();
  };
  EXPECT_EQ(address_seen(server.Connect()), "127.0.0.1");
}

TEST(GrpcServer, PlainTextIsForThisMachineOnly) {
  const test::TempFolder folder;
  const Result<config::ServerConfig> config = ParseConfig(
      "data_dir: \"data\" listen_address: \"0.0.0.0:0\" plaintext: true", "x", folder.path());
  ASSERT_TRUE(config.has_value());
  const auto server = Server::Start({.config = *config, .password_cost = {1, 8192}});
  ASSERT_FALSE(server.has_value());
  EXPECT_EQ(server.error().code(), vs::StatusCode::kFailedPrecondition);
  EXPECT_THAT(server.error().message(), HasSubstr("use TLS"));
}

// The certificate that really comes over the wire, seen by an independent program.
std::string ServedFingerprint(uint16_t port) {
  const test::TempFolder folder;
  const auto shown = test::RunProcess(
      {"openssl", "s_client", "-connect", Str("127.0.0.1:", port), "-alpn", "h2", "-showcerts"});
  if (!shown) return "";
  std::ofstream(folder / "served.pem") << shown->output;
  const auto fingerprint =
      test::RunProcess({"openssl", "x509", "-in", (folder / "served.pem").string(), "-noout",
                        "-fingerprint", "-sha256"});
  return fingerprint ? fingerprint->output : "";
}

TEST(Tls, ServesTheCertificateWhoseFingerprintItPrints) {
  TestServer server({.tls = true});
  ASSERT_FALSE(server->fingerprint().empty());
  EXPECT_THAT(ServedFingerprint(server->port()), HasSubstr(server->fingerprint()));
  EXPECT_TRUE(Serves(server));
}

TEST(Tls, KeepsItsCertificateOverARestart) {
  TestServer server({.tls = true});
  const std::string before = server->fingerprint();
  server.Restart();
  EXPECT_EQ(server->fingerprint(), before);
}

TEST(Tls, RefusesOldProtocols) {
  TestServer server({.tls = true});
  const auto connect = [&](const std::string& version) {
    return *test::RunProcess({"openssl", "s_client", "-connect", Str("127.0.0.1:", server->port()),
                              "-alpn", "h2", version, "-cipher", "ALL:@SECLEVEL=0"});
  };
  EXPECT_NE(connect("-tls1").exit_code, 0);
  EXPECT_NE(connect("-tls1_1").exit_code, 0);
  EXPECT_EQ(connect("-tls1_2").exit_code, 0);
  EXPECT_EQ(connect("-tls1_3").exit_code, 0);
}

TEST(Tls, ClientWithAnotherCertificateDoesNotConnect) {
  TestServer server({.tls = true});
  const test::TempFolder folder;
  const CertificateFiles other = *EnsureCertificate(folder.path());
  std::ifstream file(other.certificate);
  const auto credentials =
      grpc::SslCredentials({.pem_root_certs = {std::istreambuf_iterator<char>(file), {}}});
  grpc::ChannelArguments arguments;
  arguments.SetSslTargetNameOverride("localhost");
  EXPECT_EQ(CallRaw(grpc::CreateCustomChannel(server.Target(), credentials, arguments), kInfo, "")
                .status.error_code(),
            grpc::StatusCode::UNAVAILABLE);
}

TEST(Tls, TakesANewCertificateWithoutARestart) {
  TestServer server({.tls = true});
  const std::shared_ptr<grpc::Channel> old_client = server.Connect();
  test::RawCall stream(old_client, "/grpc.health.v1.Health/Watch", server.Token(Role::kViewer));
  ASSERT_TRUE(stream.Send("") && stream.Receive());

  const test::TempFolder folder;
  const CertificateFiles fresh = *EnsureCertificate(folder.path());
  const std::string fingerprint = CheckCertificate(fresh)->fingerprint;
  const std::filesystem::path tls = server.data_dir() / "tls";
  std::filesystem::rename(fresh.key, tls / "server.key");
  std::filesystem::rename(fresh.certificate, tls / "server.crt");
  EXPECT_TRUE(WaitUntil(
      [&] { return ServedFingerprint(server->port()).find(fingerprint) != std::string::npos; }));
  EXPECT_TRUE(Serves(server));
  // Who was connected stays so.
  server->health().Set("", false);
  EXPECT_TRUE(stream.Receive().has_value());
}

}  // namespace
}  // namespace vs
