#pragma once

#include <atomic>
#include <cstdint>
#include <deque>
#include <memory>
#include <vector>

#include "engine/base/mutex.h"
#include "engine/sim/gevsim/faults.h"
#include "engine/sim/gevsim/gvcp_server.h"
#include "engine/sim/gevsim/gvsp_frame.h"
#include "engine/sim/gevsim/udp_socket.h"

namespace vs::sim {

struct StreamCounters {
  std::atomic<uint64_t> frames = 0;           // sent, perhaps not whole
  std::atomic<uint64_t> packets = 0;          // sent for the first time
  std::atomic<uint64_t> resent = 0;           // sent again on demand
  std::atomic<uint64_t> unavailable = 0;      // wanted again, but gone
  std::atomic<uint64_t> dropped_packets = 0;  // by a fault
  std::atomic<uint64_t> dropped_frames = 0;
};

// How fast packets may follow each other.
struct Pacing {
  double link_mbps = 1000;      // 0 = as fast as the host can
  int64_t packet_delay_ns = 0;  // between any two packets (GevSCPD)
};

// When the packets of one frame are due.
struct PacketSchedule {
  int64_t start_ns = 0;
  int64_t packet_ns = 0;  // for which a packet occupies the link

  // `packet_bytes` as in GvspFrame; all packets count as full.
  static PacketSchedule Make(int64_t start_ns, int packet_bytes, const Pacing& pacing);
  // Packet `number`, from 0, does not leave before.
  int64_t DueNs(size_t number) const { return start_ns + static_cast<int64_t>(number) * packet_ns; }
};

// Sends frames as packets, spread over the time that the camera's network link would need, and
// keeps the last few for clients that have missed something.
class StreamSender {
 public:
  explicit StreamSender(Faults& faults) : faults_(faults) {}

  // Takes a free port of `address`.
  Status Open(uint32_t address);
  uint16_t LocalPort() const { return socket_.LocalPort(); }

  // Blocks until the last packet is out or `stop` is set. For one thread.
  void Send(const std::shared_ptr<const GvspFrame>& frame, const Endpoint& to, const Pacing& pacing,
            const std::atomic<bool>& stop);
  // Sends packets of one of the last frames once more. From any thread.
  void Resend(const ResendRequest& request, const Endpoint& to);
  // A single packet of `packet_bytes` (with headers) that must not be fragmented on its way: if it
  // arrives, the network can carry packets of that size.
  void SendTestPacket(int packet_bytes, const Endpoint& to);

  const StreamCounters& Counters() const { return counters_; }

 private:
  static constexpr size_t kFramesKept = 4;
  static constexpr int kBurst = 16;

  std::vector<uint32_t> OrderOf(uint32_t packet_count, const FaultSettings& faults);
  void SendBurst(const GvspFrame& frame, const uint32_t* numbers, int count, const sockaddr_in& to);
  void Keep(const std::shared_ptr<const GvspFrame>& frame) VS_EXCLUDES(mutex_);
  std::shared_ptr<const GvspFrame> Find(uint16_t block_id) VS_EXCLUDES(mutex_);

  Faults& faults_;
  UdpSocket socket_;
  StreamCounters counters_;
  Mutex mutex_;
  std::deque<std::shared_ptr<const GvspFrame>> kept_ VS_GUARDED_BY(mutex_);
};

}  // namespace vs::sim
