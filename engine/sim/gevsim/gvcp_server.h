#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>

#include "engine/sim/gevsim/control_privilege.h"
#include "engine/sim/gevsim/gvcp.h"
#include "engine/sim/gevsim/registers.h"

namespace vs::sim {

// A request for packets to be sent again. Both ends count.
struct ResendRequest {
  uint16_t block_id = 0;
  uint32_t first_packet = 0;
  uint32_t last_packet = 0;
};

struct ActionCommand {
  uint32_t device_key = 0;
  uint32_t group_key = 0;
  uint32_t group_mask = 0;
  std::optional<uint64_t> at_ticks;  // at once if empty
};

// What a device does when it is told to. Called on the thread that handles GVCP.
class GvcpActions {
 public:
  virtual ~GvcpActions() = default;
  // A client has written a register.
  virtual void OnWritten(uint32_t address, uint32_t value) = 0;
  virtual void OnResend(const ResendRequest& request) = 0;
  // False if the action was meant for a time that has passed.
  virtual bool OnAction(const ActionCommand& action) = 0;
  // The controlling client has given up control, or was silent for too long.
  virtual void OnControlEnded(bool silent) = 0;
};

// The control protocol of one device: takes datagrams, gives answers. Knows no sockets. For one
// thread.
class GvcpServer {
 public:
  GvcpServer(Registers& registers, GvcpActions& actions)
      : registers_(registers), actions_(actions) {}

  // The answer to a datagram, empty if none is due. Valid until the next call.
  std::span<const uint8_t> Handle(std::span<const uint8_t> datagram, const Endpoint& client,
                                  int64_t now_ns);
  // To be called now and then: takes control away from a silent client.
  void Tick(int64_t now_ns);

 private:
  struct Answer {
    GevStatus status = GevStatus::kSuccess;
    size_t payload_bytes = 0;
  };

  Answer Dispatch(GvcpCommand command, uint8_t flags, std::span<const uint8_t> payload,
                  const Endpoint& client, int64_t now_ns);
  Answer ReadRegisters(std::span<const uint8_t> payload, const Endpoint& client);
  Answer WriteRegisters(std::span<const uint8_t> payload, const Endpoint& client, int64_t now_ns);
  Answer ReadMemory(std::span<const uint8_t> payload, const Endpoint& client);
  Answer WriteMemory(std::span<const uint8_t> payload, const Endpoint& client);
  Answer Action(uint8_t flags, std::span<const uint8_t> payload);
  void Resend(uint8_t flags, std::span<const uint8_t> payload);
  GevStatus WriteRegister(uint32_t address, std::span<const uint8_t> value, const Endpoint& client,
                          int64_t now_ns);
  void ControlChanged(bool held_before, bool silent);
  std::span<uint8_t> Payload() { return std::span(answer_).subspan(kGvcpHeaderBytes); }

  Registers& registers_;
  GvcpActions& actions_;
  ControlPrivilege privilege_;
  std::array<uint8_t, kGvcpHeaderBytes + kGvcpMaxPayloadBytes> answer_{};
};

}  // namespace vs::sim
