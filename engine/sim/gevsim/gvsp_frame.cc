#include "engine/sim/gevsim/gvsp_frame.h"

#include <algorithm>

#include "engine/sim/gevsim/bytes.h"
#include "engine/sim/gevsim/gvcp.h"
#include "engine/sim/gevsim/register_addresses.h"

namespace vs::sim {
namespace {

constexpr int kHeaderBytes = 8;
enum class Format : uint8_t { kLeader = 1, kTrailer = 2, kPayload = 3 };

size_t PictureBytes(const GvspFrame& frame) {
  return static_cast<size_t>(frame.picture.width()) * frame.picture.height();
}

size_t BytesPerPacket(const GvspFrame& frame) {
  return static_cast<size_t>(frame.packet_bytes - kIpUdpGvspHeaderBytes);
}

void BuildHeader(GevStatus status, uint16_t block_id, Format format, uint32_t number,
                 int header_bytes, GvspPacket& packet) {
  packet.header.fill(0);
  PutU16(&packet.header[0], static_cast<uint16_t>(status));
  PutU16(&packet.header[2], block_id);
  PutU32(&packet.header[4], (static_cast<uint32_t>(format) << 24) | number);
  packet.parts[0] = {packet.header.data(), static_cast<size_t>(header_bytes)};
  packet.part_count = 1;
}

void BuildLeader(const GvspFrame& frame, GvspPacket& packet) {
  BuildHeader(GevStatus::kSuccess, frame.block_id, Format::kLeader, 0, kHeaderBytes + 36, packet);
  uint8_t* leader = &packet.header[kHeaderBytes];
  PutU16(leader + 2, frame.payload_type);
  PutU32(leader + 4, static_cast<uint32_t>(frame.ticks >> 32));
  PutU32(leader + 8, static_cast<uint32_t>(frame.ticks));
  PutU32(leader + 12, kPixelFormatMono8);
  PutU32(leader + 16, static_cast<uint32_t>(frame.picture.width()));
  PutU32(leader + 20, static_cast<uint32_t>(frame.picture.height()));
  PutU32(leader + 24, static_cast<uint32_t>(frame.offset_x));
  PutU32(leader + 28, static_cast<uint32_t>(frame.offset_y));
}

void BuildTrailer(const GvspFrame& frame, uint32_t number, GvspPacket& packet) {
  BuildHeader(GevStatus::kSuccess, frame.block_id, Format::kTrailer, number, kHeaderBytes + 8,
              packet);
  PutU16(&packet.header[kHeaderBytes + 2], frame.payload_type);
  PutU32(&packet.header[kHeaderBytes + 4], static_cast<uint32_t>(frame.picture.height()));
}

}  // namespace

uint32_t PacketCount(const GvspFrame& frame) {
  const size_t bytes = BytesPerPacket(frame);
  return static_cast<uint32_t>(2 + (PictureBytes(frame) + bytes - 1) / bytes);
}

void BuildPacket(const GvspFrame& frame, uint32_t number, GvspPacket& packet) {
  if (number == 0) return BuildLeader(frame, packet);
  if (number + 1 == PacketCount(frame)) return BuildTrailer(frame, number, packet);
  BuildHeader(GevStatus::kSuccess, frame.block_id, Format::kPayload, number, kHeaderBytes, packet);
  const size_t begin = (number - 1) * BytesPerPacket(frame);
  const size_t count = std::min(BytesPerPacket(frame), PictureBytes(frame) - begin);
  // sendmsg only reads, but its vector knows no const.
  packet.parts[1] = {const_cast<uint8_t*>(frame.picture.Row(0)) + begin, count};
  packet.part_count = 2;
}

void BuildUnavailable(uint16_t block_id, uint32_t number, GvspPacket& packet) {
  BuildHeader(GevStatus::kPacketUnavailable, block_id, Format::kPayload, number, kHeaderBytes,
              packet);
}

}  // namespace vs::sim
