#pragma once

#include <cstdint>

namespace vs::sim {

// Numbers in network byte order.
inline uint16_t GetU16(const uint8_t* bytes) {
  return static_cast<uint16_t>((bytes[0] << 8) | bytes[1]);
}
inline uint32_t GetU32(const uint8_t* bytes) {
  return (static_cast<uint32_t>(GetU16(bytes)) << 16) | GetU16(bytes + 2);
}
inline void PutU16(uint8_t* bytes, uint16_t value) {
  bytes[0] = static_cast<uint8_t>(value >> 8);
  bytes[1] = static_cast<uint8_t>(value);
}
inline void PutU32(uint8_t* bytes, uint32_t value) {
  PutU16(bytes, static_cast<uint16_t>(value >> 16));
  PutU16(bytes + 2, static_cast<uint16_t>(value));
}

}  // namespace vs::sim
