#include "engine/sim/gevsim/gvcp_server.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "engine/sim/gevsim/bytes.h"
#include "engine/sim/gevsim/register_addresses.h"

namespace vs::sim {
namespace {

using testing::_;
using testing::Field;
using testing::Return;

constexpr Endpoint kClient = {0x7f000001, 5000};
constexpr Endpoint kOther = {0x7f000001, 5001};

class MockActions : public GvcpActions {
 public:
  MOCK_METHOD(void, OnWritten, (uint32_t, uint32_t), (override));
  MOCK_METHOD(void, OnResend, (const ResendRequest&), (override));
  MOCK_METHOD(bool, OnAction, (const ActionCommand&), (override));
  MOCK_METHOD(void, OnControlEnded, (bool), (override));
};

struct Answer {
  GevStatus status;
  uint16_t command;
  std::vector<uint8_t> payload;
};

class Gvcp : public testing::Test {
 protected:
  // Nothing if the device does not answer.
  std::optional<Answer> Ask(GvcpCommand command, const std::vector<uint32_t>& words,
                            const Endpoint& client = kClient, uint8_t flags = kGvcpAnswerWanted) {
    std::vector<uint8_t> datagram(kGvcpHeaderBytes + 4 * words.size());
    datagram[0] = kGvcpKey;
    datagram[1] = flags;
    PutU16(&datagram[2], static_cast<uint16_t>(command));
    PutU16(&datagram[4], static_cast<uint16_t>(4 * words.size()));
    PutU16(&datagram[6], 77);
    for (size_t i = 0; i < words.size(); ++i) PutU32(&datagram[kGvcpHeaderBytes + 4 * i], words[i]);
    const auto answer = server_.Handle(datagram, client, now_ns_);
    if (answer.empty()) return std::nullopt;
    EXPECT_EQ(GetU16(&answer[6]), 77);
    EXPECT_EQ(GetU16(&answer[4]), answer.size() - kGvcpHeaderBytes);
    return Answer{GevStatus{GetU16(&answer[0])},
                  GetU16(&answer[2]),
                  {answer.begin() + kGvcpHeaderBytes, answer.end()}};
  }
  GevStatus Write(uint32_t address, uint32_t value, const Endpoint& client = kClient) {
    return Ask(GvcpCommand::kWriteRegister, {address, value}, client)->status;
  }
  uint32_t Read(uint32_t address) {
    return GetU32(Ask(GvcpCommand::kReadRegister, {address})->payload.data());
  }
  void TakeControl() {
    ASSERT_EQ(Write(reg::kControlPrivilege, kPrivilegeControl), GevStatus::kSuccess);
  }

  Registers registers_{{.serial_number = "21000001",
                        .user_name = "left",
                        .address = 0x7f000001,
                        .subnet_mask = 0xff000000,
                        .sensor_width = 1296,
                        .sensor_height = 966},
                       "<xml of 20 bytes/>.."};
  testing::NiceMock<MockActions> actions_;
  GvcpServer server_{registers_, actions_};
  int64_t now_ns_ = 0;
};

TEST_F(Gvcp, DiscoveryTellsWhoTheDeviceIs) {
  const auto answer = Ask(GvcpCommand::kDiscovery, {});
  ASSERT_TRUE(answer.has_value());
  EXPECT_EQ(answer->command, 0x0003);
  ASSERT_EQ(answer->payload.size(), 248u);
  const auto text = [&](uint32_t address) {
    return std::string(reinterpret_cast<const char*>(&answer->payload[address]));
  };
  EXPECT_EQ(text(reg::kManufacturerName), "Basler");
  EXPECT_EQ(text(reg::kModelName), "acA1300-30gm");
  EXPECT_EQ(text(reg::kSerialNumber), "21000001");
  EXPECT_EQ(text(reg::kUserName), "left");
  EXPECT_EQ(GetU32(&answer->payload[reg::kCurrentAddress]), 0x7f000001u);
}

TEST_F(Gvcp, ReadsSeveralRegistersAtOnce) {
  const auto answer = Ask(GvcpCommand::kReadRegister, {reg::kWidth, reg::kHeight, reg::kVersion});
  EXPECT_EQ(answer->status, GevStatus::kSuccess);
  ASSERT_EQ(answer->payload.size(), 12u);
  EXPECT_EQ(GetU32(&answer->payload[0]), 1296u);
  EXPECT_EQ(GetU32(&answer->payload[4]), 966u);
  EXPECT_EQ(GetU32(&answer->payload[8]), 0x00010002u);
}

TEST_F(Gvcp, RefusesWritesWithoutControl) {
  EXPECT_EQ(Write(reg::kGain, 5), GevStatus::kAccessDenied);
  TakeControl();
  EXPECT_EQ(Write(reg::kGain, 5), GevStatus::kSuccess);
  EXPECT_EQ(Write(reg::kGain, 6, kOther), GevStatus::kAccessDenied);
  EXPECT_EQ(Read(reg::kGain), 5u);
}

TEST_F(Gvcp, AnswersEachMistakeWithItsOwnCode) {
  TakeControl();
  EXPECT_EQ(Write(reg::kWidth + 1, 5), GevStatus::kBadAlignment);
  EXPECT_EQ(Write(0x5000, 5), GevStatus::kInvalidAddress);
  EXPECT_EQ(Write(reg::kSensorWidth, 5), GevStatus::kWriteProtect);
  EXPECT_EQ(Write(reg::kXmlBegin, 5), GevStatus::kWriteProtect);
  EXPECT_EQ(Write(reg::kGain, 501), GevStatus::kInvalidParameter);
  EXPECT_EQ(Ask(GvcpCommand::kReadRegister, {0x5000})->status, GevStatus::kInvalidAddress);
  EXPECT_EQ(Ask(GvcpCommand::kReadRegister, {})->status, GevStatus::kInvalidParameter);
  EXPECT_EQ(Ask(GvcpCommand{0x00c0}, {})->status, GevStatus::kNotImplemented);
}

TEST_F(Gvcp, SaysWhichOfSeveralWritesFailed) {
  TakeControl();
  const auto answer = Ask(GvcpCommand::kWriteRegister,
                          {reg::kGain, 7, reg::kBlackLevel, 9, reg::kGain, 5000, reg::kGain, 8});
  EXPECT_EQ(answer->status, GevStatus::kInvalidParameter);
  EXPECT_EQ(GetU32(answer->payload.data()), 2u);
  EXPECT_EQ(Read(reg::kGain), 7u);
  EXPECT_EQ(Read(reg::kBlackLevel), 9u);
}

TEST_F(Gvcp, ReadsTheXmlThroughMemory) {
  const auto answer = Ask(GvcpCommand::kReadMemory, {reg::kXmlBegin + 4, 16});
  EXPECT_EQ(answer->status, GevStatus::kSuccess);
  EXPECT_EQ(std::string(answer->payload.begin() + 4, answer->payload.end()), " of 20 bytes/>..");
  EXPECT_EQ(Ask(GvcpCommand::kReadMemory, {reg::kXmlBegin + 4, 20})->status,
            GevStatus::kInvalidAddress);
  EXPECT_EQ(Ask(GvcpCommand::kReadMemory, {reg::kXmlBegin, 3})->status,
            GevStatus::kInvalidParameter);
}

TEST_F(Gvcp, WritesTheUserNameThroughMemory) {
  TakeControl();
  const auto answer =
      Ask(GvcpCommand::kWriteMemory, {reg::kUserName, 0x63616d00 /* "cam" */, 0, 0, 0});
  EXPECT_EQ(answer->status, GevStatus::kSuccess);
  EXPECT_EQ(GetU32(answer->payload.data()), 16u);
  EXPECT_EQ(Read(reg::kUserName), 0x63616d00u);
}

TEST_F(Gvcp, IgnoresGarbage) {
  const std::vector<std::vector<uint8_t>> datagrams = {
      {},
      {0x42},
      {0x41, 1, 0, 2, 0, 0, 0, 1},     // wrong key
      {0x42, 1, 0, 0x80, 0, 4, 0, 1},  // shorter than it says
      {0x42, 1, 0, 2, 0, 0, 0, 0},     // request number 0
  };
  for (const auto& datagram : datagrams) {
    EXPECT_TRUE(server_.Handle(datagram, kClient, 0).empty()) << datagram.size();
  }
}

TEST_F(Gvcp, AnswersOnlyWhenAsked) {
  EXPECT_EQ(Ask(GvcpCommand::kReadRegister, {reg::kWidth}, kClient, 0), std::nullopt);
}

TEST_F(Gvcp, ReleasesTheControlOfASilentClient) {
  TakeControl();
  EXPECT_CALL(actions_, OnControlEnded(true)).Times(1);
  now_ns_ = 2'900'000'000;
  EXPECT_EQ(Read(reg::kControlPrivilege), kPrivilegeControl);  // a sign of life
  server_.Tick(now_ns_ += 2'900'000'000);
  EXPECT_EQ(Write(reg::kControlPrivilege, kPrivilegeControl, kOther), GevStatus::kAccessDenied);
  server_.Tick(now_ns_ += 200'000'000);
  EXPECT_EQ(Write(reg::kControlPrivilege, kPrivilegeControl, kOther), GevStatus::kSuccess);
}

TEST_F(Gvcp, TellsWhenControlIsGivenUp) {
  TakeControl();
  EXPECT_CALL(actions_, OnControlEnded(false)).Times(1);
  EXPECT_EQ(Write(reg::kControlPrivilege, 0), GevStatus::kSuccess);
}

TEST_F(Gvcp, PassesOnWhatWasWritten) {
  TakeControl();
  EXPECT_CALL(actions_, OnWritten(reg::kAcquisitionStart, 1));
  EXPECT_EQ(Write(reg::kAcquisitionStart, 1), GevStatus::kSuccess);
}

TEST_F(Gvcp, PassesOnRequestsForPackets) {
  EXPECT_CALL(actions_, OnResend(testing::AllOf(Field(&ResendRequest::block_id, 65501),
                                                Field(&ResendRequest::first_packet, 3u),
                                                Field(&ResendRequest::last_packet, 5u))));
  EXPECT_EQ(Ask(GvcpCommand::kPacketResend, {65501, 3, 5}), std::nullopt);
  EXPECT_CALL(actions_, OnResend(_)).Times(0);
  Ask(GvcpCommand::kPacketResend, {1, 2});  // too short
}

TEST_F(Gvcp, SaysWhenAnActionComesTooLate) {
  EXPECT_CALL(actions_, OnAction(Field(&ActionCommand::at_ticks, 0x1'0000'0005u)))
      .WillOnce(Return(false));
  const uint8_t scheduled = kGvcpAnswerWanted | kGvcpScheduledTime;
  EXPECT_EQ(Ask(GvcpCommand::kAction, {1, 2, 3, 1, 5}, kClient, scheduled)->status,
            GevStatus::kActionLate);
  EXPECT_EQ(Ask(GvcpCommand::kAction, {1, 2, 3}, kClient, scheduled)->status,
            GevStatus::kInvalidParameter);
}

TEST_F(Gvcp, BinningShrinksTheWindow) {
  TakeControl();
  EXPECT_EQ(Write(reg::kWidth, 1000), GevStatus::kSuccess);
  EXPECT_EQ(Write(reg::kOffsetX, 296), GevStatus::kSuccess);
  EXPECT_EQ(Write(reg::kOffsetX, 297), GevStatus::kInvalidParameter);
  EXPECT_EQ(Write(reg::kBinningX, 2), GevStatus::kSuccess);
  EXPECT_EQ(Read(reg::kWidth), 500u);
  EXPECT_EQ(Read(reg::kOffsetX), 148u);
  EXPECT_EQ(Read(reg::kWidthMax), 648u);
  EXPECT_EQ(Read(reg::kPayloadSize), 500u * 966u);
  EXPECT_EQ(Write(reg::kBinningX, 1), GevStatus::kSuccess);
  EXPECT_EQ(Read(reg::kWidth), 1000u);
}

TEST_F(Gvcp, KeepsTheFormatWhilePicturesAreTaken) {
  TakeControl();
  registers_.Set(reg::kAcquisitionActive, 1);
  EXPECT_EQ(Write(reg::kWidth, 1000), GevStatus::kAccessDenied);
  EXPECT_EQ(Write(reg::kExposureUs, 1000), GevStatus::kSuccess);
}

TEST_F(Gvcp, FreeRunningRateIsWhatTheSettingsAllow) {
  TakeControl();
  EXPECT_EQ(registers_.PeriodNs(), 32'844'000);  // 966 rows of 34 us
  EXPECT_EQ(Write(reg::kFramePeriodUs, 50'000), GevStatus::kSuccess);
  EXPECT_EQ(registers_.PeriodNs(), 32'844'000);
  EXPECT_EQ(Write(reg::kFrameRateEnable, 1), GevStatus::kSuccess);
  EXPECT_EQ(registers_.PeriodNs(), 50'000'000);
  EXPECT_EQ(Write(reg::kExposureUs, 70'000), GevStatus::kSuccess);
  EXPECT_EQ(registers_.PeriodNs(), 70'000'000);
}

}  // namespace
}  // namespace vs::sim
