#pragma once

#include <sys/uio.h>

#include <array>
#include <cstdint>

#include "engine/image/image.h"

namespace vs::sim {

// A picture as the GigE Vision Streaming Protocol sends it (GigE Vision specification 2.0): a
// leader that describes it, its pixels in packets of equal size, a trailer. Packets are numbered
// from 0.
struct GvspFrame {
  uint16_t block_id = 0;      // counts frames, 1 .. 65535, never 0
  uint16_t payload_type = 1;  // 1 = picture; others are for tests of clients
  uint64_t ticks = 0;         // timestamp
  int offset_x = 0;           // of the picture on the sensor
  int offset_y = 0;
  GreyImage picture;        // rows without gaps
  int packet_bytes = 1500;  // with IP, UDP and GVSP headers
};

inline constexpr int kIpUdpGvspHeaderBytes = 36;
inline constexpr int kMinPacketBytes = 220;
inline constexpr int kMaxPacketBytes = 16404;

uint32_t PacketCount(const GvspFrame& frame);

// One packet, ready for sendmsg: `parts` point into `header` and into the frame's picture.
struct GvspPacket {
  std::array<uint8_t, 48> header;
  std::array<iovec, 2> parts;
  int part_count = 0;
};
// `number` is below PacketCount. The packet must not be moved afterwards.
void BuildPacket(const GvspFrame& frame, uint32_t number, GvspPacket& packet);
// Tells the client that a packet it wants again is gone for good.
void BuildUnavailable(uint16_t block_id, uint32_t number, GvspPacket& packet);

}  // namespace vs::sim
