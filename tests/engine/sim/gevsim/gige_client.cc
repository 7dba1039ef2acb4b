#include "tests/engine/sim/gevsim/gige_client.h"

#include <gtest/gtest.h>
#include <poll.h>
#include <sys/socket.h>

#include <algorithm>

#include "engine/sim/gevsim/bytes.h"
#include "engine/sim/gevsim/register_addresses.h"

namespace vs::sim {
namespace {

using std::chrono::milliseconds;
using Clock = std::chrono::steady_clock;

constexpr size_t kGvspHeaderBytes = 8;

UdpSocket BindTo(uint32_t address) {
  auto socket = UdpSocket::Bind({address, 0});
  EXPECT_TRUE(socket.has_value());
  return socket ? std::move(*socket) : UdpSocket();
}

bool Readable(const UdpSocket& socket, milliseconds patience) {
  pollfd waiting = {socket.fd(), POLLIN, 0};
  return poll(&waiting, 1, static_cast<int>(patience.count())) == 1;
}

milliseconds Left(Clock::time_point deadline) {
  return std::max(milliseconds(0),
                  std::chrono::duration_cast<milliseconds>(deadline - Clock::now()));
}

}  // namespace

GigeClient::GigeClient(const std::string& camera_address, const std::string& own_address)
    : camera_(*ParseAddress(camera_address)),
      own_(*ParseAddress(own_address)),
      control_(BindTo(own_)),
      stream_(BindTo(own_)) {
  const int bytes = 4 << 20;
  setsockopt(stream_.fd(), SOL_SOCKET, SO_RCVBUF, &bytes, sizeof bytes);
}

void GigeClient::Send(GvcpCommand command, const std::vector<uint32_t>& words, uint8_t flags,
                      uint32_t address) {
  std::vector<uint8_t> datagram(kGvcpHeaderBytes + 4 * words.size());
  if (++request_ == 0) ++request_;
  datagram[0] = kGvcpKey;
  datagram[1] = flags;
  PutU16(&datagram[2], static_cast<uint16_t>(command));
  PutU16(&datagram[4], static_cast<uint16_t>(4 * words.size()));
  PutU16(&datagram[6], request_);
  for (size_t i = 0; i < words.size(); ++i) PutU32(&datagram[kGvcpHeaderBytes + 4 * i], words[i]);
  control_.Send(datagram, {address, kGvcpPort});
}

std::optional<GigeClient::Answer> GigeClient::Ask(GvcpCommand command,
                                                  const std::vector<uint32_t>& words,
                                                  milliseconds patience, uint8_t flags) {
  Send(command, words, flags, camera_);
  const Clock::time_point deadline = Clock::now() + patience;
  while (Readable(control_, Left(deadline))) {
    std::vector<uint8_t> bytes(1024);
    Endpoint from;
    bytes.resize(static_cast<size_t>(control_.Receive(bytes, &from)));
    if (bytes.size() < kGvcpHeaderBytes || GetU16(&bytes[6]) != request_) continue;
    EXPECT_EQ(GetU16(&bytes[2]), static_cast<uint16_t>(command) + 1);
    return Answer{GevStatus{GetU16(&bytes[0])}, {bytes.begin() + kGvcpHeaderBytes, bytes.end()}};
  }
  return std::nullopt;
}

std::set<std::string> GigeClient::Discover(const std::string& address, size_t count) {
  // The loopback interface is the only one here, but not the way to 255.255.255.255.
  setsockopt(control_.fd(), SOL_SOCKET, SO_BINDTODEVICE, "lo", 2);
  Send(GvcpCommand::kDiscovery, {}, kGvcpAnswerWanted, *ParseAddress(address));
  std::set<std::string> serial_numbers;
  const Clock::time_point deadline = Clock::now() + test::kPatience;
  while (serial_numbers.size() < count && Readable(control_, Left(deadline))) {
    std::vector<uint8_t> bytes(1024);
    Endpoint from;
    const int received = control_.Receive(bytes, &from);
    if (received < kGvcpHeaderBytes + static_cast<int>(reg::kDiscoveryEnd)) continue;
    serial_numbers.insert(
        reinterpret_cast<const char*>(&bytes[kGvcpHeaderBytes + reg::kSerialNumber]));
  }
  return serial_numbers;
}

GevStatus GigeClient::Write(uint32_t address, uint32_t value) {
  const auto answer = Ask(GvcpCommand::kWriteRegister, {address, value});
  EXPECT_TRUE(answer.has_value()) << "no answer to a write of register " << address;
  return answer ? answer->status : GevStatus::kNotImplemented;
}

uint32_t GigeClient::Read(uint32_t address) {
  const auto answer = Ask(GvcpCommand::kReadRegister, {address});
  EXPECT_TRUE(answer && answer->payload.size() == 4) << "no value of register " << address;
  return answer && answer->payload.size() == 4 ? GetU32(answer->payload.data()) : 0;
}

void GigeClient::OpenStream(int packet_bytes) {
  EXPECT_EQ(Write(reg::kControlPrivilege, kPrivilegeControl), GevStatus::kSuccess);
  EXPECT_EQ(Write(reg::kStreamDestination, own_), GevStatus::kSuccess);
  EXPECT_EQ(Write(reg::kStreamPort, stream_.LocalPort()), GevStatus::kSuccess);
  EXPECT_EQ(Write(reg::kStreamPacketSize, static_cast<uint32_t>(packet_bytes)),
            GevStatus::kSuccess);
  data_bytes_ = static_cast<size_t>(packet_bytes) - 36;
}

std::vector<uint8_t> GigeClient::NextDatagram(milliseconds patience) {
  std::vector<uint8_t> bytes(65536);
  Endpoint from;
  bytes.resize(Readable(stream_, patience) ? static_cast<size_t>(stream_.Receive(bytes, &from))
                                           : 0);
  return bytes;
}

std::optional<ReceivedFrame> GigeClient::NextFrame(milliseconds patience) {
  const Clock::time_point deadline = Clock::now() + patience;
  while (true) {
    for (auto id = order_.begin(); id != order_.end(); ++id) {
      if (!frames_[*id].missing.empty()) continue;
      ReceivedFrame frame = std::move(frames_[*id]);
      frames_.erase(*id);
      order_.erase(id);
      return frame;
    }
    if (Clock::now() >= deadline) return std::nullopt;
    const auto datagram = NextDatagram(std::min(milliseconds(50), Left(deadline)));
    if (datagram.empty()) {
      RequestMissing();
    } else {
      TakeApart(datagram);
    }
  }
}

void GigeClient::TakeApart(const std::vector<uint8_t>& datagram) {
  if (datagram.size() < kGvspHeaderBytes) return;
  const uint16_t status = GetU16(&datagram[0]);
  const uint16_t block_id = GetU16(&datagram[2]);
  const uint8_t format = datagram[4];
  const uint32_t number = GetU32(&datagram[4]) & 0xffffff;
  if (status != 0) {
    ++unavailable_;
    return;
  }
  auto [entry, is_new] = frames_.try_emplace(block_id);
  ReceivedFrame& frame = entry->second;
  if (is_new) {
    // What the whole frame will be is known from the camera's registers.
    order_.push_back(block_id);
    frame.block_id = block_id;
    frame.pixels.resize(Read(reg::kPayloadSize));
    const size_t packets = 2 + (frame.pixels.size() + data_bytes_ - 1) / data_bytes_;
    for (uint32_t i = 0; i < packets; ++i) frame.missing.insert(i);
  }
  const uint8_t* data = &datagram[kGvspHeaderBytes];
  if (format == 1) {
    frame.payload_type = GetU16(data + 2);
    frame.ticks = (uint64_t{GetU32(data + 4)} << 32) | GetU32(data + 8);
    frame.width = static_cast<int>(GetU32(data + 16));
    frame.height = static_cast<int>(GetU32(data + 20));
  } else if (format == 3) {
    const size_t begin = (number - 1) * data_bytes_;
    const size_t count = datagram.size() - kGvspHeaderBytes;
    ASSERT_LE(begin + count, frame.pixels.size());
    std::copy_n(data, count, frame.pixels.begin() + static_cast<ptrdiff_t>(begin));
  }
  frame.missing.erase(number);
}

void GigeClient::RequestMissing() {
  for (const auto& [block_id, frame] : frames_) {
    for (const uint32_t number : frame.missing) {
      Send(GvcpCommand::kPacketResend, {block_id, number, number}, 0, camera_);
      ++requested_;
    }
  }
}

}  // namespace vs::sim
