#pragma once

#include <chrono>
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "engine/sim/gevsim/gvcp.h"
#include "engine/sim/gevsim/gvcp_server.h"
#include "engine/sim/gevsim/udp_socket.h"
#include "tests/support/child_process.h"

namespace vs::sim {

// A picture as it came over the network.
struct ReceivedFrame {
  uint16_t block_id = 0;
  uint16_t payload_type = 0;
  uint64_t ticks = 0;
  int width = 0;
  int height = 0;
  std::vector<uint8_t> pixels;
  std::set<uint32_t> missing;  // packets
};

// The plainest GigE Vision client that can be, for tests of the camera. Written against the
// specification and independent of the camera's own code but for names.
class GigeClient {
 public:
  struct Answer {
    GevStatus status = GevStatus::kSuccess;
    std::vector<uint8_t> payload;
  };

  // A client at `own_address` of the camera at `camera_address`.
  explicit GigeClient(const std::string& camera_address,
                      const std::string& own_address = "127.0.0.1");

  // Nothing if the camera does not answer in time.
  std::optional<Answer> Ask(GvcpCommand command, const std::vector<uint32_t>& words,
                            std::chrono::milliseconds patience = test::kPatience,
                            uint8_t flags = kGvcpAnswerWanted);
  // Serial numbers of all that answer a discovery sent to `address`, until `count` have.
  std::set<std::string> Discover(const std::string& address, size_t count);

  GevStatus Write(uint32_t address, uint32_t value);
  uint32_t Read(uint32_t address);

  // Takes control and points the camera's stream at this client.
  void OpenStream(int packet_bytes);
  // The next frame that is whole, asking again for packets that do not come.
  std::optional<ReceivedFrame> NextFrame(std::chrono::milliseconds patience = test::kPatience);
  // The next datagram of the stream as it is, empty if none comes.
  std::vector<uint8_t> NextDatagram(std::chrono::milliseconds patience = test::kPatience);

  // Packets that the camera said it does not have any more.
  int Unavailable() const { return unavailable_; }
  // Packets that were asked for again.
  int Requested() const { return requested_; }

 private:
  void Send(GvcpCommand command, const std::vector<uint32_t>& words, uint8_t flags,
            uint32_t address);
  void TakeApart(const std::vector<uint8_t>& datagram);
  void RequestMissing();

  uint32_t camera_ = 0;
  uint32_t own_ = 0;
  UdpSocket control_;
  UdpSocket stream_;
  uint16_t request_ = 0;
  size_t data_bytes_ = 0;  // of a stream packet
  std::map<uint16_t, ReceivedFrame> frames_;
  std::vector<uint16_t> order_;  // in which frames began
  int unavailable_ = 0;
  int requested_ = 0;
};

}  // namespace vs::sim
