#include "engine/sim/gevsim/gvcp_server.h"

#include <algorithm>

#include "engine/sim/gevsim/bytes.h"
#include "engine/sim/gevsim/register_addresses.h"

namespace vs::sim {

std::span<const uint8_t> GvcpServer::Handle(std::span<const uint8_t> datagram,
                                            const Endpoint& client, int64_t now_ns) {
  if (datagram.size() < kGvcpHeaderBytes || datagram[0] != kGvcpKey) return {};
  const uint8_t flags = datagram[1];
  const uint16_t command = GetU16(&datagram[2]);
  const size_t length = GetU16(&datagram[4]);
  const uint16_t request = GetU16(&datagram[6]);
  const auto payload = datagram.subspan(kGvcpHeaderBytes);
  if (request == 0 || payload.size() < length) return {};

  privilege_.Heard(client, now_ns);
  const Answer answer =
      Dispatch(GvcpCommand{command}, flags, payload.first(length), client, now_ns);
  if ((flags & kGvcpAnswerWanted) == 0 || command == static_cast<uint16_t>(GvcpCommand::kForceIp) ||
      command == static_cast<uint16_t>(GvcpCommand::kPacketResend)) {
    return {};
  }
  PutU16(&answer_[0], static_cast<uint16_t>(answer.status));
  PutU16(&answer_[2], static_cast<uint16_t>(command + 1));
  PutU16(&answer_[4], static_cast<uint16_t>(answer.payload_bytes));
  PutU16(&answer_[6], request);
  return std::span(answer_).first(kGvcpHeaderBytes + answer.payload_bytes);
}

void GvcpServer::Tick(int64_t now_ns) {
  const int64_t timeout_ns = int64_t{registers_.Get(reg::kHeartbeatTimeout)} * 1'000'000;
  if (privilege_.ExpireSilent(now_ns, timeout_ns)) ControlChanged(true, true);
}

GvcpServer::Answer GvcpServer::Dispatch(GvcpCommand command, uint8_t flags,
                                        std::span<const uint8_t> payload, const Endpoint& client,
                                        int64_t now_ns) {
  switch (command) {
    case GvcpCommand::kDiscovery:
      return {registers_.Read(0, Payload().first(reg::kDiscoveryEnd)), reg::kDiscoveryEnd};
    case GvcpCommand::kForceIp:
      return {};  // our address is the host's business
    case GvcpCommand::kPacketResend:
      Resend(flags, payload);
      return {};
    case GvcpCommand::kReadRegister:
      return ReadRegisters(payload, client);
    case GvcpCommand::kWriteRegister:
      return WriteRegisters(payload, client, now_ns);
    case GvcpCommand::kReadMemory:
      return ReadMemory(payload, client);
    case GvcpCommand::kWriteMemory:
      return WriteMemory(payload, client);
    case GvcpCommand::kAction:
      return Action(flags, payload);
  }
  return {GevStatus::kNotImplemented};
}

GvcpServer::Answer GvcpServer::ReadRegisters(std::span<const uint8_t> payload,
                                             const Endpoint& client) {
  if (!privilege_.MayRead(client)) return {GevStatus::kAccessDenied};
  if (payload.empty() || payload.size() % 4 != 0 || payload.size() > kGvcpMaxPayloadBytes) {
    return {GevStatus::kInvalidParameter};
  }
  for (size_t i = 0; i < payload.size(); i += 4) {
    const GevStatus status = registers_.Read(GetU32(&payload[i]), Payload().subspan(i, 4));
    // What was read so far is told.
    if (status != GevStatus::kSuccess) return {status, i};
  }
  return {GevStatus::kSuccess, payload.size()};
}

GvcpServer::Answer GvcpServer::WriteRegisters(std::span<const uint8_t> payload,
                                              const Endpoint& client, int64_t now_ns) {
  uint16_t done = 0;
  GevStatus status = GevStatus::kInvalidParameter;
  if (!payload.empty() && payload.size() % 8 == 0 && payload.size() <= kGvcpMaxPayloadBytes) {
    status = GevStatus::kSuccess;
    for (size_t i = 0; i < payload.size(); i += 8, ++done) {
      status = WriteRegister(GetU32(&payload[i]), payload.subspan(i + 4, 4), client, now_ns);
      if (status != GevStatus::kSuccess) break;
    }
  }
  PutU16(&Payload()[0], 0);
  PutU16(&Payload()[2], done);  // the index of the register that failed, or how many there were
  return {status, 4};
}

GevStatus GvcpServer::WriteRegister(uint32_t address, std::span<const uint8_t> value,
                                    const Endpoint& client, int64_t now_ns) {
  if (address == reg::kControlPrivilege) {
    const bool held_before = privilege_.Held();
    const GevStatus status = privilege_.Request(client, GetU32(value.data()), now_ns);
    ControlChanged(held_before, false);
    return status;
  }
  if (!privilege_.MayWrite(client)) return GevStatus::kAccessDenied;
  const GevStatus status = registers_.Write(address, value);
  if (status == GevStatus::kSuccess) actions_.OnWritten(address, GetU32(value.data()));
  return status;
}

GvcpServer::Answer GvcpServer::ReadMemory(std::span<const uint8_t> payload,
                                          const Endpoint& client) {
  if (!privilege_.MayRead(client)) return {GevStatus::kAccessDenied};
  if (payload.size() != 8) return {GevStatus::kInvalidParameter};
  const size_t count = GetU16(&payload[6]);
  if (count % 4 != 0 || count > kGvcpMaxMemoryBytes) return {GevStatus::kInvalidParameter};
  const uint32_t address = GetU32(&payload[0]);
  PutU32(&Payload()[0], address);
  const GevStatus status = registers_.Read(address, Payload().subspan(4, count));
  return {status, status == GevStatus::kSuccess ? 4 + count : 0};
}

GvcpServer::Answer GvcpServer::WriteMemory(std::span<const uint8_t> payload,
                                           const Endpoint& client) {
  PutU32(&Payload()[0], 0);
  if (!privilege_.MayWrite(client)) return {GevStatus::kAccessDenied, 4};
  if (payload.size() < 8 || payload.size() > 4 + kGvcpMaxMemoryBytes) {
    return {GevStatus::kInvalidParameter, 4};
  }
  const uint32_t address = GetU32(&payload[0]);
  const auto bytes = payload.subspan(4);
  const GevStatus status = registers_.Write(address, bytes);
  if (status == GevStatus::kSuccess) {
    PutU16(&Payload()[2], static_cast<uint16_t>(bytes.size()));
    for (size_t i = 0; i < bytes.size(); i += 4) {
      actions_.OnWritten(address + static_cast<uint32_t>(i), GetU32(&bytes[i]));
    }
  }
  return {status, 4};
}

GvcpServer::Answer GvcpServer::Action(uint8_t flags, std::span<const uint8_t> payload) {
  const bool scheduled = (flags & kGvcpScheduledTime) != 0;
  if (payload.size() < (scheduled ? 20u : 12u)) return {GevStatus::kInvalidParameter};
  ActionCommand action = {.device_key = GetU32(&payload[0]),
                          .group_key = GetU32(&payload[4]),
                          .group_mask = GetU32(&payload[8])};
  if (scheduled) {
    action.at_ticks = (uint64_t{GetU32(&payload[12])} << 32) | GetU32(&payload[16]);
  }
  return {actions_.OnAction(action) ? GevStatus::kSuccess : GevStatus::kActionLate};
}

void GvcpServer::Resend(uint8_t flags, std::span<const uint8_t> payload) {
  // 64-bit block ids are of GigE Vision 2; we stream with 16 bits.
  if (payload.size() < 12 || (flags & kGvcpExtendedIds) != 0) return;
  actions_.OnResend({.block_id = GetU16(&payload[2]),
                     .first_packet = GetU32(&payload[4]) & 0xffffff,
                     .last_packet = GetU32(&payload[8]) & 0xffffff});
}

void GvcpServer::ControlChanged(bool held_before, bool silent) {
  registers_.Set(reg::kControlPrivilege, privilege_.RegisterValue());
  if (held_before && !privilege_.Held()) actions_.OnControlEnded(silent);
}

}  // namespace vs::sim
