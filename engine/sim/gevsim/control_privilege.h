#pragma once

#include <cstdint>
#include <optional>

#include "engine/sim/gevsim/gvcp.h"
#include "engine/sim/gevsim/udp_socket.h"

namespace vs::sim {

// Which client may control the device (GigE Vision 2.0, 10.5 and 10.7). One client at a time has
// control; it keeps it as long as it is heard from. In exclusive mode nobody else may even read.
class ControlPrivilege {
 public:
  // What a client writes into the privilege register: 0 gives control up, else it asks for control
  // or exclusive access.
  GevStatus Request(const Endpoint& client, uint32_t wanted, int64_t now_ns);
  // Any command of the controlling client is a sign of life.
  void Heard(const Endpoint& client, int64_t now_ns);
  // Takes control away from a client that has been silent for too long; true if so.
  bool ExpireSilent(int64_t now_ns, int64_t timeout_ns);

  bool MayRead(const Endpoint& client) const { return !exclusive_ || Holds(client); }
  bool MayWrite(const Endpoint& client) const { return Holds(client); }
  bool Held() const { return holder_.has_value(); }
  // As the privilege register shows it.
  uint32_t RegisterValue() const;

 private:
  bool Holds(const Endpoint& client) const { return holder_ == client; }

  std::optional<Endpoint> holder_;
  bool exclusive_ = false;
  int64_t heard_ns_ = 0;
};

}  // namespace vs::sim
