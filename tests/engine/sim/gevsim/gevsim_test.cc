// The program as a whole, over the (loopback) network.

#include "tests/support/gevsim.h"

#include <gtest/gtest.h>
#include <net/if.h>
#include <signal.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <fstream>

#include "engine/sim/demo_rig.h"
#include "engine/sim/device_clock.h"
#include "engine/sim/gevsim/register_addresses.h"
#include "engine/sim/scene_camera.h"
#include "tests/engine/sim/gevsim/gige_client.h"
#include "tests/support/temp_folder.h"
#include "tests/support/wait_until.h"

namespace vs::sim {
namespace {

using std::chrono::milliseconds;
using test::ChildProcess;
using test::WaitUntil;

constexpr milliseconds kNotYet{300};  // long enough to believe that nothing comes

constexpr int kWidth = 60;
constexpr int kHeight = 40;

// Cameras that show small pictures from files, so that they start at once.
class GevSim : public testing::Test {
 protected:
  void SetUp() override {
    for (const char* name : {"0_left.pgm", "0_right.pgm"}) {
      std::string pixels;
      for (int i = 0; i < kWidth * kHeight; ++i) pixels += static_cast<char>(i * 7 % 251);
      std::ofstream(folder_ / name, std::ios::binary) << "P5\n"
                                                      << kWidth << " " << kHeight << "\n255\n"
                                                      << pixels;
    }
  }

  // A sanitizer's complaint shows in the exit code.
  void TearDown() override {
    if (gevsim_ == nullptr) return;
    gevsim_->Signal(SIGTERM);
    const auto exit_code = gevsim_->WaitForExit();
    EXPECT_TRUE(exit_code == 0 || exit_code == 128 + SIGKILL) << gevsim_->ErrorOutput();
  }

  void Start(std::vector<std::string> options) {
    options.insert(options.end(), {"--folder", folder_.path(), "--control", Socket()});
    auto started = test::StartGevSim(options);
    ASSERT_TRUE(started.has_value()) << started.error().ToString();
    gevsim_ = std::move(*started);
  }

  std::string Socket() const { return folder_ / "socket"; }
  std::string Command(const std::string& command) {
    const auto answer = test::AskGevSim(Socket(), command);
    return answer ? *answer : answer.error().message();
  }
  // Opens the stream, to be triggered by the line.
  static void OpenTriggered(GigeClient& client, TriggerSource source, int packet_bytes = 576) {
    client.OpenStream(packet_bytes);
    EXPECT_EQ(client.Write(reg::kTriggerMode, 1), GevStatus::kSuccess);
    EXPECT_EQ(client.Write(reg::kTriggerSource, static_cast<uint32_t>(source)),
              GevStatus::kSuccess);
    EXPECT_EQ(client.Write(reg::kAcquisitionStart, 1), GevStatus::kSuccess);
  }
  // One picture after one pulse of the line.
  std::optional<ReceivedFrame> Pulse(GigeClient& client, milliseconds patience = test::kPatience) {
    EXPECT_EQ(Command("trigger"), "ok");
    return client.NextFrame(patience);
  }

  test::TempFolder folder_;
  std::unique_ptr<ChildProcess> gevsim_;
};

TEST_F(GevSim, AnswersDiscoveryHoweverItIsAsked) {
  Start({"--fps", "0"});
  GigeClient client("127.0.0.1");
  EXPECT_EQ(client.Discover("127.0.0.1", 1), std::set<std::string>{"21000001"});
  EXPECT_EQ(client.Discover("127.0.0.2", 1), std::set<std::string>{"21000002"});
  const std::set<std::string> both = {"21000001", "21000002"};
  EXPECT_EQ(client.Discover("127.255.255.255", 2), both);
  EXPECT_EQ(client.Discover("255.255.255.255", 2), both);
}

TEST_F(GevSim, SendsThePicturesOfItsFolderUnchanged) {
  Start({"--fps", "0"});
  GigeClient client("127.0.0.2");
  OpenTriggered(client, TriggerSource::kLine1);
  const auto frame = Pulse(client);
  ASSERT_TRUE(frame.has_value());
  EXPECT_EQ(frame->payload_type, 1);
  EXPECT_EQ(frame->width, kWidth);
  EXPECT_EQ(frame->height, kHeight);
  for (int i = 0; i < kWidth * kHeight; ++i) ASSERT_EQ(frame->pixels[i], i * 7 % 251) << i;
}

TEST_F(GevSim, OneLinePulseTriggersBothCamerasAtOneInstant) {
  Start({"--fps", "50"});
  GigeClient left("127.0.0.1");
  GigeClient right("127.0.0.2");
  OpenTriggered(left, TriggerSource::kLine1);
  OpenTriggered(right, TriggerSource::kLine1);
  std::set<uint64_t> left_ticks;
  for (int i = 0; i < 20; ++i) left_ticks.insert(left.NextFrame()->ticks);
  for (const uint64_t ticks : left_ticks) EXPECT_EQ(ticks % 20'000'000, 0u);
  // The right camera came later; from then on it has the very same instants.
  EXPECT_TRUE(WaitUntil([&] { return left_ticks.contains(right.NextFrame()->ticks); }));
}

TEST_F(GevSim, TwoProgramsShareTheLine) {
  Start({"--fps", "50", "--only", "left"});
  const auto other =
      test::StartGevSim({"--fps", "50", "--only", "right", "--folder", folder_.path()});
  ASSERT_TRUE(other.has_value()) << other.error().ToString();
  GigeClient right("127.0.0.2");
  OpenTriggered(right, TriggerSource::kLine1);
  EXPECT_EQ(right.NextFrame()->ticks % 20'000'000, 0u);
}

TEST_F(GevSim, NumbersFramesUpTo65535AndLeavesOutZero) {
  Start({"--fps", "0", "--first-block-id", "65534"});
  GigeClient client("127.0.0.1");
  OpenTriggered(client, TriggerSource::kLine1);
  for (const uint16_t expected : {65534, 65535, 1, 2}) {
    EXPECT_EQ(Pulse(client)->block_id, expected);
  }
}

TEST_F(GevSim, SendsLostPacketsAgainUntilTheyArrive) {
  Start({"--fps", "0", "--fault", "left drop 0.3"});
  GigeClient client("127.0.0.1");
  OpenTriggered(client, TriggerSource::kLine1, 220);  // 14 packets a frame
  for (int frames = 0; frames < 5;) {
    // Once in many millions of times all packets are lost, and then there is nothing to ask for.
    const auto frame = Pulse(client);
    ASSERT_TRUE(frame.has_value());
    for (int i = 0; i < kWidth * kHeight; ++i) ASSERT_EQ(frame->pixels[i], i * 7 % 251);
    ++frames;
  }
  EXPECT_GT(client.Requested(), 0);
  const std::string statistics = Command("stats");
  EXPECT_EQ(statistics.substr(0, statistics.find(';')).find(" resent 0 "), std::string::npos);
}

TEST_F(GevSim, SaysThatAnOldFrameIsGone) {
  Start({"--fps", "0", "--first-block-id", "100"});
  GigeClient client("127.0.0.1");
  OpenTriggered(client, TriggerSource::kLine1);
  for (int i = 0; i < 5; ++i) ASSERT_TRUE(Pulse(client).has_value());
  // Of 100 .. 104 the last four are kept.
  client.Ask(GvcpCommand::kPacketResend, {100, 1, 1}, milliseconds(0), 0);
  const auto answer = client.NextDatagram();
  ASSERT_EQ(answer.size(), 8u);
  EXPECT_EQ((answer[0] << 8) | answer[1], 0x800c);
  client.Ask(GvcpCommand::kPacketResend, {101, 1, 1}, milliseconds(0), 0);
  EXPECT_EQ(client.NextDatagram().size(), 8u + 540u);
}

TEST_F(GevSim, TakesOnePictureForEachSoftwareTrigger) {
  Start({"--fps", "100"});  // pulses on the line do not matter now
  GigeClient client("127.0.0.1");
  OpenTriggered(client, TriggerSource::kSoftware);
  EXPECT_FALSE(client.NextFrame(kNotYet).has_value());
  for (int i = 0; i < 3; ++i) {
    EXPECT_EQ(client.Write(reg::kTriggerSoftware, 1), GevStatus::kSuccess);
    EXPECT_TRUE(client.NextFrame().has_value());
  }
  EXPECT_FALSE(client.NextFrame(kNotYet).has_value());
}

TEST_F(GevSim, TakesPicturesOnActionCommandsThatAreMeantForIt) {
  Start({"--fps", "0"});
  GigeClient client("127.0.0.1");
  OpenTriggered(client, TriggerSource::kAction1);
  EXPECT_EQ(client.Write(reg::kActionDeviceKey, 11), GevStatus::kSuccess);
  EXPECT_EQ(client.Write(reg::kActionGroupKey, 22), GevStatus::kSuccess);
  EXPECT_EQ(client.Write(reg::kActionGroupMask, 6), GevStatus::kSuccess);
  EXPECT_EQ(client.Ask(GvcpCommand::kAction, {11, 22, 1})->status, GevStatus::kSuccess);
  EXPECT_EQ(client.Ask(GvcpCommand::kAction, {12, 22, 2})->status, GevStatus::kSuccess);
  EXPECT_FALSE(client.NextFrame(kNotYet).has_value());
  EXPECT_EQ(client.Ask(GvcpCommand::kAction, {11, 22, 2})->status, GevStatus::kSuccess);
  EXPECT_TRUE(client.NextFrame().has_value());
  // A time in the future is kept to the tick, one in the past is refused.
  EXPECT_EQ(client.Write(reg::kTimestampControl, kTimestampLatch), GevStatus::kSuccess);
  const uint64_t at =
      ((uint64_t{client.Read(reg::kTimestampHigh)} << 32) | client.Read(reg::kTimestampLow)) +
      2'000'000'000;
  const std::vector<uint32_t> scheduled = {11, 22, 2, static_cast<uint32_t>(at >> 32),
                                           static_cast<uint32_t>(at)};
  const uint8_t flags = kGvcpAnswerWanted | kGvcpScheduledTime;
  const auto answer = client.Ask(GvcpCommand::kAction, scheduled, test::kPatience, flags);
  if (answer->status == GevStatus::kSuccess) {  // unless this machine slept for two seconds
    EXPECT_EQ(client.NextFrame()->ticks, at);
  }
  EXPECT_EQ(client.Ask(GvcpCommand::kAction, {11, 22, 2, 0, 1}, test::kPatience, flags)->status,
            GevStatus::kActionLate);
}

TEST_F(GevSim, FreeRunsAtTheRateThatWasSet) {
  Start({"--fps", "0"});
  GigeClient client("127.0.0.1");
  client.OpenStream(576);
  EXPECT_EQ(client.Write(reg::kFramePeriodUs, 20'000), GevStatus::kSuccess);
  EXPECT_EQ(client.Write(reg::kFrameRateEnable, 1), GevStatus::kSuccess);
  EXPECT_EQ(client.Write(reg::kAcquisitionStart, 1), GevStatus::kSuccess);
  const uint64_t first = client.NextFrame()->ticks;
  for (int i = 0; i < 5; ++i) EXPECT_EQ((client.NextFrame()->ticks - first) % 20'000'000, 0u);
}

TEST_F(GevSim, TakesASinglePictureInSingleFrameMode) {
  Start({"--fps", "0"});
  GigeClient client("127.0.0.1");
  client.OpenStream(576);
  EXPECT_EQ(client.Write(reg::kAcquisitionMode, 1), GevStatus::kSuccess);
  EXPECT_EQ(client.Write(reg::kAcquisitionStart, 1), GevStatus::kSuccess);
  EXPECT_TRUE(client.NextFrame().has_value());
  EXPECT_TRUE(WaitUntil([&] { return client.Read(reg::kAcquisitionActive) == 0; }));
  EXPECT_FALSE(client.NextFrame(kNotYet).has_value());
}

TEST_F(GevSim, RefusesASecondClientUntilTheFirstIsSilent) {
  Start({"--fps", "0"});
  auto first = std::make_unique<GigeClient>("127.0.0.1");
  first->OpenStream(576);
  EXPECT_EQ(first->Write(reg::kAcquisitionStart, 1), GevStatus::kSuccess);
  GigeClient second("127.0.0.1");
  EXPECT_EQ(second.Write(reg::kControlPrivilege, kPrivilegeControl), GevStatus::kAccessDenied);
  EXPECT_EQ(second.Write(reg::kGain, 3), GevStatus::kAccessDenied);
  EXPECT_EQ(second.Read(reg::kWidth), static_cast<uint32_t>(kWidth));

  EXPECT_EQ(first->Write(reg::kHeartbeatTimeout, 100), GevStatus::kSuccess);
  first.reset();
  EXPECT_TRUE(WaitUntil([&] {
    return second.Write(reg::kControlPrivilege, kPrivilegeControl) == GevStatus::kSuccess;
  }));
  // Nothing is left of what the first had begun.
  EXPECT_EQ(second.Read(reg::kStreamPort), 0u);
  EXPECT_EQ(second.Read(reg::kAcquisitionActive), 0u);
}

TEST_F(GevSim, TestPacketsFindOutWhatTheNetworkCarries) {
  const int fd = socket(AF_INET, SOCK_DGRAM, 0);
  ifreq request{};
  std::strcpy(request.ifr_name, "lo");
  request.ifr_mtu = 1500;
  ASSERT_EQ(ioctl(fd, SIOCSIFMTU, &request), 0);
  close(fd);
  Start({"--fps", "0"});
  GigeClient client("127.0.0.1");
  client.OpenStream(1500);
  EXPECT_EQ(client.Write(reg::kStreamPacketSize, kTestPacketFlag | 4000), GevStatus::kSuccess);
  EXPECT_TRUE(client.NextDatagram(kNotYet).empty());
  EXPECT_EQ(client.Write(reg::kStreamPacketSize, kTestPacketFlag | 1500), GevStatus::kSuccess);
  EXPECT_EQ(client.NextDatagram().size(), 1500u - 28u);
  EXPECT_EQ(client.Read(reg::kStreamPacketSize), 1500u);
}

TEST_F(GevSim, DoesWrongWhatItIsToldTo) {
  Start({"--fps", "0"});
  GigeClient client("127.0.0.1");
  OpenTriggered(client, TriggerSource::kLine1);

  EXPECT_EQ(Command("left black on"), "ok");
  const auto black = Pulse(client);
  EXPECT_EQ(std::count(black->pixels.begin(), black->pixels.end(), 0), kWidth * kHeight);
  EXPECT_EQ(Command("left black off"), "ok");

  EXPECT_EQ(Command("payload-type 6 1"), "ok");
  EXPECT_EQ(Pulse(client)->payload_type, 6);
  EXPECT_EQ(Command("clear"), "ok");
  EXPECT_EQ(Pulse(client)->payload_type, 1);

  EXPECT_EQ(Command("left drop-frames 1"), "ok");
  EXPECT_FALSE(Pulse(client, kNotYet).has_value());
  EXPECT_TRUE(
      WaitUntil([&] { return Command("stats").find("dropped-frames 1") != std::string::npos; }));
  EXPECT_EQ(Command("clear"), "ok");

  EXPECT_EQ(Command("left freeze 1000"), "ok");
  EXPECT_EQ(Command("trigger"), "ok");
  EXPECT_TRUE(
      WaitUntil([&] { return Command("stats").find("missed-triggers 1") != std::string::npos; }));
  EXPECT_EQ(client.Read(reg::kWidth), static_cast<uint32_t>(kWidth));  // only pictures stop
  EXPECT_EQ(Command("clear"), "ok");

  EXPECT_EQ(Command("left unplug"), "ok");
  EXPECT_EQ(client.Ask(GvcpCommand::kReadRegister, {reg::kWidth}, kNotYet), std::nullopt);
  EXPECT_EQ(GigeClient("127.0.0.2").Read(reg::kWidth), static_cast<uint32_t>(kWidth));
  EXPECT_EQ(Command("left plug"), "ok");
  EXPECT_EQ(client.Read(reg::kWidth), static_cast<uint32_t>(kWidth));

  EXPECT_EQ(Command("reorder 1"), "ok");
  EXPECT_EQ(Command("duplicate 1"), "ok");
  EXPECT_EQ(Pulse(client)->pixels[1], 7);
}

TEST_F(GevSim, ExplainsCommandsThatItDoesNotKnow) {
  Start({"--fps", "0"});
  EXPECT_EQ(Command("left dance").substr(0, 28), "error: unknown fault 'dance'");
  EXPECT_EQ(Command("").substr(0, 7), "error: ");
  EXPECT_EQ(Command(std::string(300, 'x')).substr(0, 7), "error: ");
}

TEST_F(GevSim, EndsCleanlyWhenAsked) {
  for (const int signal : {SIGTERM, SIGINT}) {
    Start({});
    EXPECT_TRUE(std::filesystem::exists(Socket()));
    gevsim_->Signal(signal);
    EXPECT_EQ(gevsim_->WaitForExit(), 0);
    EXPECT_FALSE(std::filesystem::exists(Socket()));
    EXPECT_NE(gevsim_->Output().find("left frames 0"), std::string::npos);
  }
}

TEST_F(GevSim, EndsByItselfAfterItsDuration) {
  Start({"--duration", "0.2"});
  EXPECT_EQ(gevsim_->WaitForExit(), 0);
}

TEST_F(GevSim, CanBeKilledAndStartedAgain) {
  for (int i = 0; i < 2; ++i) {
    Start({});
    GigeClient client("127.0.0.1");
    OpenTriggered(client, TriggerSource::kLine1);
    EXPECT_TRUE(client.NextFrame().has_value());
    gevsim_->Kill();
  }
}

TEST_F(GevSim, RefusesCommandLinesThatMakeNoSense) {
  const test::TempFolder empty;
  const std::vector<std::pair<std::vector<std::string>, std::string>> wrong = {
      {{"--left", "localhost"}, "localhost"},
      {{"--left", "10.255.255.1"}, "10.255.255.1"},
      {{"--folder", "/nowhere"}, "/nowhere"},
      {{"--folder", empty.path()}, "as many left as right"},
      {{"--folder", folder_.path(), "--right-pattern", "*"}, "as many left as right"},
      {{"--folder", folder_.path(), "--fault", "left dance"}, "dance"},
      {{"--folder", folder_.path(), "--control", "/nowhere/socket"}, "/nowhere/socket"},
      {{"--fps", "-5"}, "--fps"},
      {{"--dance"}, "--dance"},
  };
  for (const auto& [options, expected] : wrong) {
    const auto started = test::StartGevSim(options);
    ASSERT_FALSE(started.has_value()) << expected;
    EXPECT_NE(started.error().message().find(expected), std::string::npos)
        << started.error().message();
  }
}

// The scene itself, in full size.
TEST(GevSimScene, ItsFramesAreTheLibrarysPicturesOfTheirTimestamps) {
  const auto gevsim = test::StartGevSim({"--fps", "5", "--seed", "42", "--tick-hz", "125000000",
                                         "--left-offset-ms", "3000", "--left-drift-ppm", "50"});
  ASSERT_TRUE(gevsim.has_value()) << gevsim.error().ToString();
  const DeviceClock clocks[] = {
      {.tick_hz = 125'000'000, .offset_ns = 3'000'000'000, .drift_ppm = 50},
      {.tick_hz = 125'000'000}};
  const char* const addresses[] = {"127.0.0.1", "127.0.0.2"};
  BufferPool pool;
  for (const Side side : {Side::kLeft, Side::kRight}) {
    const int i = side == Side::kLeft ? 0 : 1;
    GigeClient client(addresses[i]);
    client.OpenStream(8192);
    EXPECT_EQ(client.Write(reg::kBinningX, 2), GevStatus::kSuccess);
    EXPECT_EQ(client.Write(reg::kBinningY, 2), GevStatus::kSuccess);
    EXPECT_EQ(client.Write(reg::kExposureUs, 8000), GevStatus::kSuccess);
    EXPECT_EQ(client.Write(reg::kTriggerMode, 1), GevStatus::kSuccess);
    EXPECT_EQ(client.Write(reg::kAcquisitionStart, 1), GevStatus::kSuccess);
    const auto frame = client.NextFrame();
    ASSERT_TRUE(frame.has_value());
    ASSERT_EQ(frame->width, 648);
    ASSERT_EQ(frame->height, 483);

    SceneCamera camera({.rig = DemoRig(),
                        .side = side,
                        .sensitivity = side == Side::kLeft ? 1.0 : 1.03,
                        .noise = {1, 42}});
    GreyImage expected(pool, 648, 483);
    SensorSettings settings = camera.DefaultSettings();
    settings.binning_x = settings.binning_y = 2;
    settings.width = 648;
    settings.height = 483;
    settings.exposure_us = 8000;
    const auto timestamp_ns = static_cast<int64_t>(frame->ticks * 8);
    camera.Capture(clocks[i].InstantOf(timestamp_ns), settings, expected);
    EXPECT_EQ(std::memcmp(expected.Row(0), frame->pixels.data(), frame->pixels.size()), 0);
  }
}

TEST(GevSimUsage, RefusesACommandLineThatMakesNoSense) {
  const auto done = test::RunProcess({VS_GEVSIM, "--dance"});
  ASSERT_TRUE(done.has_value()) << done.error().ToString();
  EXPECT_EQ(done->exit_code, 2);
  EXPECT_TRUE(done->error_output.starts_with("gevsim: ")) << done->error_output;
  EXPECT_NE(done->error_output.find("--dance"), std::string::npos) << done->error_output;
}

}  // namespace
}  // namespace vs::sim
