#include "engine/sim/gevsim/stream_sender.h"

#include <gtest/gtest.h>
#include <poll.h>

#include <array>
#include <atomic>
#include <memory>
#include <thread>
#include <vector>

#include "engine/base/clock.h"
#include "engine/image/buffer.h"

namespace vs::sim {
namespace {

constexpr int64_t kMs = 1'000'000;
constexpr int64_t kEarlyNs = 20'000;  // by how much a packet may be early

// A full packet has 38 bytes more on the Ethernet than in IP: (1500 + 38) * 8 bit = 12304 bit.
TEST(PacketSchedule, SpreadsPacketsOverTheTimeThatTheLinkNeeds) {
  EXPECT_EQ(PacketSchedule::Make(0, 1500, {.link_mbps = 1000}).packet_ns, 12'304);
  EXPECT_EQ(PacketSchedule::Make(0, 1500, {.link_mbps = 100}).packet_ns, 123'040);
  EXPECT_EQ(PacketSchedule::Make(0, 9000, {.link_mbps = 1000}).packet_ns, 72'304);
  EXPECT_EQ(PacketSchedule::Make(0, 1500, {.link_mbps = 1000, .packet_delay_ns = 5000}).packet_ns,
            17'304);
  EXPECT_EQ(PacketSchedule::Make(0, 1500, {.link_mbps = 0, .packet_delay_ns = 5000}).packet_ns,
            5000);
  EXPECT_EQ(PacketSchedule::Make(0, 1500, {.link_mbps = 0}).packet_ns, 0);

  const PacketSchedule schedule = PacketSchedule::Make(7, 1500, {.link_mbps = 1000});
  EXPECT_EQ(schedule.DueNs(0), 7);
  EXPECT_EQ(schedule.DueNs(1), 12'311);
  EXPECT_EQ(schedule.DueNs(1000), 12'304'007);
}

// Sends a frame of 32 packets to this machine itself; for each packet, the time from before the
// first one was sent until it was here. A busy machine makes these longer, never shorter.
std::vector<int64_t> ArrivalsNs(const Pacing& pacing) {
  constexpr uint32_t kLoopback = 0x7f000001;
  Faults faults;
  StreamSender sender(faults);
  EXPECT_TRUE(sender.Open(kLoopback).ok());
  const UdpSocket receiver = UdpSocket::Bind({kLoopback, 0}).value();
  BufferPool pool;
  auto frame = std::make_shared<GvspFrame>();
  frame->packet_bytes = 1500;
  frame->picture = GreyImage(pool, 1464, 30);  // 30 full packets, and leader and trailer
  frame->picture.Fill(0);
  EXPECT_EQ(PacketCount(*frame), 32u);

  const SystemClock clock;
  const std::atomic<bool> stop = false;
  const int64_t start_ns = clock.MonotonicNs();
  std::thread sending([&] { sender.Send(frame, {kLoopback, receiver.LocalPort()}, pacing, stop); });
  std::vector<int64_t> arrivals_ns;
  std::array<uint8_t, 2048> bytes;
  pollfd readable{.fd = receiver.fd(), .events = POLLIN, .revents = 0};
  constexpr int kPatienceMs = 60'000;
  while (arrivals_ns.size() < 32 && poll(&readable, 1, kPatienceMs) == 1) {
    Endpoint from;
    if (receiver.Receive(bytes, &from) > 0) arrivals_ns.push_back(clock.MonotonicNs() - start_ns);
  }
  sending.join();
  return arrivals_ns;
}

TEST(StreamSender, KeepsThePacketDelayBetweenAnyTwoPackets) {
  const std::vector<int64_t> arrivals_ns = ArrivalsNs({.link_mbps = 0, .packet_delay_ns = 2 * kMs});
  ASSERT_EQ(arrivals_ns.size(), 32u);
  for (size_t i = 0; i < arrivals_ns.size(); ++i) {
    EXPECT_GE(arrivals_ns[i], static_cast<int64_t>(i) * 2 * kMs - kEarlyNs) << "packet " << i;
  }
}

// At 10 Mbit/s a packet takes 1.2304 ms. They leave in bursts of 16.
TEST(StreamSender, SendsNoFasterThanTheLink) {
  const std::vector<int64_t> arrivals_ns = ArrivalsNs({.link_mbps = 10});
  ASSERT_EQ(arrivals_ns.size(), 32u);
  for (size_t i = 16; i < arrivals_ns.size(); ++i) {
    EXPECT_GE(arrivals_ns[i], int64_t{16} * 1'230'400 - kEarlyNs) << "packet " << i;
  }
}

}  // namespace
}  // namespace vs::sim
