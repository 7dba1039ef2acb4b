#include "engine/sim/gevsim/stream_sender.h"

#include <sys/socket.h>
#include <time.h>

#include <algorithm>
#include <array>
#include <numeric>

#include "engine/base/clock.h"

namespace vs::sim {
namespace {

// What a packet occupies on an Ethernet besides IP: preamble, header, checksum, gap.
constexpr int kEthernetBytes = 8 + 14 + 4 + 12;
// Sleeping costs more than sending a little early.
constexpr int64_t kShortestSleepNs = 20'000;

int64_t Now() { return SystemClock().MonotonicNs(); }

void SleepUntil(int64_t instant_ns) {
  const timespec until = {instant_ns / 1'000'000'000, instant_ns % 1'000'000'000};
  clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &until, nullptr);
}

msghdr MessageOf(GvspPacket& packet, const sockaddr_in& to) {
  msghdr message{};
  message.msg_name = const_cast<sockaddr_in*>(&to);
  message.msg_namelen = sizeof to;
  message.msg_iov = packet.parts.data();
  message.msg_iovlen = static_cast<size_t>(packet.part_count);
  return message;
}

}  // namespace

PacketSchedule PacketSchedule::Make(int64_t start_ns, int packet_bytes, const Pacing& pacing) {
  const double wire_bytes = packet_bytes + kEthernetBytes;
  const double wire_ns = pacing.link_mbps > 0 ? wire_bytes * 8000 / pacing.link_mbps : 0;
  return {.start_ns = start_ns,
          .packet_ns = static_cast<int64_t>(wire_ns) + pacing.packet_delay_ns};
}

Status StreamSender::Open(uint32_t address) {
  VS_ASSIGN_OR_RETURN(socket_, UdpSocket::Bind({address, 0}));
  const int bytes = 4 << 20;
  setsockopt(socket_.fd(), SOL_SOCKET, SO_SNDBUF, &bytes, sizeof bytes);
  return {};
}

void StreamSender::Send(const std::shared_ptr<const GvspFrame>& frame, const Endpoint& to,
                        const Pacing& pacing, const std::atomic<bool>& stop) {
  const FaultSettings faults = faults_.Get();
  if (faults_.Happens(faults.drop_frames)) {
    ++counters_.dropped_frames;
    return;
  }
  Keep(frame);
  const sockaddr_in address = ToSockaddr(to);
  const std::vector<uint32_t> order = OrderOf(PacketCount(*frame), faults);
  const PacketSchedule schedule = PacketSchedule::Make(Now(), frame->packet_bytes, pacing);
  // A long delay between packets must not come in bursts of sixteen.
  const int burst = pacing.packet_delay_ns > 0 ? 1 : kBurst;
  for (size_t sent = 0; sent < order.size() && !stop;) {
    const int count = static_cast<int>(std::min<size_t>(burst, order.size() - sent));
    SendBurst(*frame, &order[sent], count, address);
    sent += static_cast<size_t>(count);
    if (schedule.DueNs(sent) > Now() + kShortestSleepNs) SleepUntil(schedule.DueNs(sent));
  }
  ++counters_.frames;
}

std::vector<uint32_t> StreamSender::OrderOf(uint32_t packet_count, const FaultSettings& faults) {
  std::vector<uint32_t> order;
  order.reserve(packet_count);
  for (uint32_t number = 0; number < packet_count; ++number) {
    if (faults.unplugged || faults_.Happens(faults.drop_packets)) {
      ++counters_.dropped_packets;
      continue;
    }
    order.push_back(number);
    if (faults_.Happens(faults.duplicate_packets)) order.push_back(number);
  }
  for (size_t i = 1; i < order.size(); ++i) {
    if (faults_.Happens(faults.reorder_packets)) std::swap(order[i - 1], order[i]);
  }
  return order;
}

void StreamSender::SendBurst(const GvspFrame& frame, const uint32_t* numbers, int count,
                             const sockaddr_in& to) {
  std::array<GvspPacket, kBurst> packets;
  std::array<mmsghdr, kBurst> messages{};
  for (int i = 0; i < count; ++i) {
    BuildPacket(frame, numbers[i], packets[i]);
    messages[i].msg_hdr = MessageOf(packets[i], to);
  }
  for (int sent = 0; sent < count;) {
    const int result = sendmmsg(socket_.fd(), &messages[sent], count - sent, 0);
    // What the network refuses is lost, as it would be on a wire; go on behind it.
    sent += std::max(result, 1);
    if (result > 0) counters_.packets += static_cast<uint64_t>(result);
  }
}

void StreamSender::Resend(const ResendRequest& request, const Endpoint& to) {
  const FaultSettings faults = faults_.Get();
  const sockaddr_in address = ToSockaddr(to);
  const std::shared_ptr<const GvspFrame> frame = Find(request.block_id);
  const uint32_t last = frame == nullptr ? request.first_packet
                                         : std::min(request.last_packet, PacketCount(*frame) - 1);
  for (uint32_t number = request.first_packet; number <= last; ++number) {
    GvspPacket packet;
    if (frame == nullptr) {
      BuildUnavailable(request.block_id, number, packet);
      ++counters_.unavailable;
    } else if (faults_.Happens(faults.drop_packets)) {
      ++counters_.dropped_packets;
      continue;
    } else {
      BuildPacket(*frame, number, packet);
      ++counters_.resent;
    }
    const msghdr message = MessageOf(packet, address);
    sendmsg(socket_.fd(), &message, 0);
  }
}

void StreamSender::SendTestPacket(int packet_bytes, const Endpoint& to) {
  constexpr int kIpUdpBytes = 28;
  if (packet_bytes <= kIpUdpBytes) return;
  const std::vector<uint8_t> bytes(static_cast<size_t>(packet_bytes - kIpUdpBytes), 0);
  const int whole = IP_PMTUDISC_DO;
  const int any = IP_PMTUDISC_DONT;
  setsockopt(socket_.fd(), IPPROTO_IP, IP_MTU_DISCOVER, &whole, sizeof whole);
  socket_.Send(bytes, to);
  setsockopt(socket_.fd(), IPPROTO_IP, IP_MTU_DISCOVER, &any, sizeof any);
}

void StreamSender::Keep(const std::shared_ptr<const GvspFrame>& frame) {
  MutexLock lock(mutex_);
  kept_.push_back(frame);
  if (kept_.size() > kFramesKept) kept_.pop_front();
}

std::shared_ptr<const GvspFrame> StreamSender::Find(uint16_t block_id) {
  MutexLock lock(mutex_);
  const auto found = std::find_if(kept_.begin(), kept_.end(), [block_id](const auto& frame) {
    return frame->block_id == block_id;
  });
  return found == kept_.end() ? nullptr : *found;
}

}  // namespace vs::sim
