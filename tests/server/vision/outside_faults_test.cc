// What goes wrong outside of the server, with real cameras' packets on a network of its own:
// cameras die, strangers send garbage to every port. Whom it concerns is told; nobody else notices.

#include <arpa/inet.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <fstream>
#include <random>
#include <sstream>
#include <string>
#include <vector>

#include "visionserver/v1/system.grpc.pb.h"

#include "engine/base/str.h"
#include "tests/server/vision/vision_fixture.h"
#include "tests/support/child_process.h"
#include "tests/support/gevsim.h"
#include "tests/support/raw_socket.h"
#include "tests/support/temp_folder.h"
#include "tests/support/wait_until.h"

namespace vs::test {
namespace {

namespace pb = visionserver::v1;
using ::testing::AllOf;
using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::SizeIs;

constexpr char kLeft[] = "cameras/gev:21000001";
constexpr char kRight[] = "cameras/gev:21000002";

// Stands before the server, so that it goes after it, which gives its cameras back.
class Cameras {
 protected:
  void StartCameras() {
    auto cameras = StartGevSim({"--noise", "0", "--fps", "10", "--control", control_path()});
    ASSERT_TRUE(cameras.has_value()) << cameras.error().ToString();
    cameras_ = std::move(*cameras);
  }
  std::string control_path() const { return (folder_ / "gevsim").string(); }

  const TempFolder folder_;
  std::unique_ptr<ChildProcess> cameras_;
};

// Two cameras, a sequence "cell" that shows their pictures, a client of it, and a client with other
// business.
class OutsideFaults : protected Cameras, public VisionTest {
 protected:
  OutsideFaults() : VisionTest({.tls = true}) {}

  void SetUp() override {
    StartCameras();
    if (HasFatalFailure()) return;
    bystander_ = StartBystander();
    const std::string small = "?Width=64&Height=48&TriggerMode=On&TriggerSource=Line1";
    SequenceSpec spec;
    spec.id = "cell";
    spec.blocks = {{"cameras",
                    "StereoCamera",
                    {{"left", "gev:21000001" + small}, {"right", "gev:21000002" + small}}},
                   {"publish", "Publish", {{"stream", std::string("pair")}}}};
    spec.connections = {{"cameras", "pair", "publish", "value"}};
    Create(spec);
    const grpc::Status started = Start("cell");
    ASSERT_TRUE(started.ok()) << started.error_message();
    client_ = std::make_unique<SteadyClient>(server_.Connect(), operator_, "cell/pair");
  }

  std::vector<std::string> AlarmIds() {
    pb::ListAlarmsResponse list;
    const grpc::Status status = pb::SystemService::NewStub(channel_)->ListAlarms(
        ClientCall(operator_).context(), pb::ListAlarmsRequest(), &list);
    EXPECT_TRUE(status.ok()) << status.error_message();
    std::vector<std::string> ids;
    for (const pb::Alarm& alarm : list.alarms()) ids.push_back(alarm.id());
    return ids;
  }
  void ExpectNobodyNotices() {
    EXPECT_TRUE(client_->GoesOn());
    EXPECT_TRUE(bystander_->GoesOn());
  }

  std::unique_ptr<SteadyClient> bystander_;
  std::unique_ptr<SteadyClient> client_;
};

std::string Noise(std::mt19937& random, size_t bytes) {
  std::string noise(bytes, '\0');
  for (char& byte : noise) byte = static_cast<char>(random());
  return noise;
}

TEST_F(OutsideFaults, CamerasThatAreKilledAreToldAndComeBackToTheirClients) {
  ASSERT_TRUE(WaitUntil([&] { return State("cell").state() == pb::SEQUENCE_RUN_STATE_RUNNING; }));
  cameras_->Kill();
  ASSERT_TRUE(WaitUntil([&] { return State("cell").state() == pb::SEQUENCE_RUN_STATE_DEGRADED; }));
  // Looked at anew: what is said about a camera changes while it is searched for.
  ASSERT_TRUE(WaitUntil([&] {
    const pb::SequenceError error = State("cell").last_error();
    return error.path() == "cell/cameras" && (error.message().starts_with("left camera: ") ||
                                              error.message().starts_with("right camera: "));
  }));
  EXPECT_TRUE(WaitUntil([&] { return server_->health().Get("sequences/cell") == false; }));
  EXPECT_TRUE(WaitUntil([&] {
    return ::testing::Matches(AllOf(Contains(kLeft), Contains(kRight), Contains("sequences/cell")))(
        AlarmIds());
  }));
  EXPECT_TRUE(bystander_->GoesOn());
  EXPECT_EQ(pb::SEQUENCE_RUN_STATE_RUNNING, State("bystander").state());

  StartCameras();
  EXPECT_TRUE(client_->GoesOn());
  EXPECT_TRUE(WaitUntil([&] { return State("cell").state() == pb::SEQUENCE_RUN_STATE_RUNNING; }));
  EXPECT_TRUE(WaitUntil([&] { return server_->health().Get("sequences/cell") == true; }));
  EXPECT_TRUE(WaitUntil([&] { return AlarmIds().empty(); }));
  EXPECT_TRUE(bystander_->GoesOn());
}

TEST_F(OutsideFaults, GarbageOnTheTlsPortReachesNobody) {
  std::mt19937 random(1);
  std::vector<std::string> garbage = {
      "GET / HTTP/1.1\r\nHost: x\r\n\r\n",
      "PRI * HTTP/2.0\r\n\r\nSM\r\n\r\n",                      // no TLS where there must be
      std::string("\x16\x03\x01\xff\xff\x01\x00\xff\xff", 9),  // a ClientHello of 64 KiB
      std::string("\x15\x03\x03\x00\x02\x02\x28", 7),          // an alert
      std::string("\x17\x03\x03\x00\x05hello", 10),            // data without a handshake
      std::string(100'000, '\0')};
  for (int i = 0; i < 30; ++i) {
    const std::string noise = Noise(random, 1 + random() % 2000);
    garbage.push_back(i % 2 == 0 ? noise : std::string("\x16\x03\x01\x02\x00\x01", 6) + noise);
  }
  for (const std::string& bytes : garbage) RawSocket(server_->port()).Send(bytes);
  ExpectNobodyNotices();

  std::vector<RawSocket> half_open;
  for (int i = 0; i < 30; ++i) {
    half_open.emplace_back(server_->port());
    if (i % 2 == 0) half_open.back().Send(std::string("\x16\x03\x01\x02\x00\x01\x00\x01\xfc", 9));
  }
  ExpectNobodyNotices();
  EXPECT_TRUE(SteadyClient(server_.Connect(), operator_, "cell/pair").GoesOn());
}

TEST_F(OutsideFaults, GarbageInsideATlsSessionReachesNobody) {
  const std::string preface =
      std::string("PRI * HTTP/2.0\r\n\r\nSM\r\n\r\n") + std::string("\0\0\0\4\0\0\0\0\0", 9);
  std::mt19937 random(2);
  std::vector<std::string> garbage = {
      "GET / HTTP/1.1\r\nHost: x\r\n\r\n", Noise(random, 5000),
      preface + std::string("\xff\xff\xff\x01\x04\0\0\0\1", 9),             // a frame of 16 MB
      preface + std::string("\0\0\4\x01\x04\0\0\0\1\xff\xff\xff\xff", 13),  // no HPACK
      preface + std::string("\0\0\5\0\0\0\0\0\7hello", 14)};                // DATA for no stream
  for (int i = 0; i < 5; ++i) garbage.push_back(preface + Noise(random, 1 + random() % 2000));
  for (const std::string& bytes : garbage) {
    const auto stranger =
        RunProcess({"openssl", "s_client", "-connect", Str("127.0.0.1:", server_->port()), "-alpn",
                    "h2", "-quiet", "-no_ign_eof"},
                   {.input = bytes});
    ASSERT_TRUE(stranger.has_value()) << stranger.error().ToString();
    // The handshake was made: what follows is what counts.
    ASSERT_THAT(stranger->error_output, HasSubstr("verify return:1"));
  }
  ExpectNobodyNotices();
}

// The UDP sockets of this network, from the kernel's list: "  12: 0100007F:0F74 00000000:0000 ..."
std::vector<sockaddr_in> UdpSockets() {
  std::ifstream file("/proc/net/udp");
  std::vector<sockaddr_in> sockets;
  std::string line;
  std::getline(file, line);  // names of the columns
  while (std::getline(file, line)) {
    std::istringstream words(line);
    std::string index;
    std::string local;
    words >> index >> local;
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = static_cast<in_addr_t>(std::stoul(local.substr(0, 8), nullptr, 16));
    address.sin_port = htons(static_cast<uint16_t>(std::stoul(local.substr(9, 4), nullptr, 16)));
    if (address.sin_addr.s_addr == htonl(INADDR_ANY)) {
      address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    }
    sockets.push_back(address);
  }
  return sockets;
}

// Beginnings of the packets that a camera and its client exchange.
const std::vector<std::string> kGigePackets = {
    "",
    std::string("\x42\x01\x00\x82\x00\x08\x00\x01", 8),          // write a register
    std::string("\x42\x01\x00\x84\x00\x08\x00\x01", 8),          // read memory
    std::string("\x00\x00\x00\x81\x00\x04\x00\x01", 8),          // an answer nobody asked for
    std::string("\x00\x00\x00\x01\x01\x00\x00\x00", 8),          // the leader of a picture
    std::string("\x00\x00\x00\x01\x03\x00\x00\x07", 8),          // a part of one
    std::string("\x00\x00\x00\x01\x02\x00\xff\xff", 8),          // its trailer
    std::string("\x00\x00\xff\xff\x81\x00\x00\x00\x00\x01", 10)  // with extended ids
};

TEST_F(OutsideFaults, GarbageOnEveryUdpPortReachesNobody) {
  // At each camera a control and a stream socket; at the server both for each camera.
  const std::vector<sockaddr_in> sockets = UdpSockets();
  ASSERT_THAT(sockets, SizeIs(::testing::Ge(8)));
  const int fd = socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  std::mt19937 random(3);
  for (int round = 0; round < 200; ++round) {
    const std::string packet = kGigePackets[static_cast<size_t>(round) % kGigePackets.size()] +
                               Noise(random, random() % 1400);
    for (const sockaddr_in& to : sockets) {
      sendto(fd, packet.data(), packet.size(), 0, reinterpret_cast<const sockaddr*>(&to),
             sizeof to);
    }
  }
  close(fd);
  ExpectNobodyNotices();
}

TEST_F(OutsideFaults, GarbageForTheSimulatorReachesNobody) {
  std::mt19937 random(4);
  for (int i = 0; i < 50; ++i) (void)AskGevSim(control_path(), Noise(random, 1 + random() % 9000));
  EXPECT_THAT(AskGevSim(control_path(), "left drop everything").error().message(),
              HasSubstr("error: "));
  // A pulse on the trigger line out of turn is a picture more.
  EXPECT_TRUE(AskGevSim(control_path(), "trigger").has_value());
  ExpectNobodyNotices();
}

}  // namespace
}  // namespace vs::test
