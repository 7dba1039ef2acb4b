#pragma once

#include <cstdint>

namespace vs::sim {

// GigE Vision Control Protocol (GigE Vision specification 2.0): one UDP datagram each way.
//
//   command: 0x42, flags, command (2), payload length (2), request id (2), payload
//   answer:  status (2), command + 1 (2), payload length (2), request id (2), payload
inline constexpr uint16_t kGvcpPort = 3956;
inline constexpr uint8_t kGvcpKey = 0x42;
inline constexpr int kGvcpHeaderBytes = 8;
inline constexpr int kGvcpMaxPayloadBytes = 540;
inline constexpr int kGvcpMaxMemoryBytes = 536;  // of one READMEM or WRITEMEM

inline constexpr uint8_t kGvcpAnswerWanted = 0x01;
inline constexpr uint8_t kGvcpExtendedIds = 0x10;    // of PACKETRESEND
inline constexpr uint8_t kGvcpScheduledTime = 0x80;  // of ACTION

enum class GvcpCommand : uint16_t {
  kDiscovery = 0x0002,
  kForceIp = 0x0004,
  kPacketResend = 0x0040,
  kReadRegister = 0x0080,
  kWriteRegister = 0x0082,
  kReadMemory = 0x0084,
  kWriteMemory = 0x0086,
  kAction = 0x0100,
};

enum class GevStatus : uint16_t {
  kSuccess = 0x0000,
  kNotImplemented = 0x8001,
  kInvalidParameter = 0x8002,
  kInvalidAddress = 0x8003,
  kWriteProtect = 0x8004,
  kBadAlignment = 0x8005,
  kAccessDenied = 0x8006,
  kPacketUnavailable = 0x800c,
  kActionLate = 0x8016,
};

}  // namespace vs::sim
