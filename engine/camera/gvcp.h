#pragma once

#include <chrono>
#include <cstdint>
#include <stop_token>
#include <string>
#include <vector>

#include "engine/base/status.h"

namespace vs {

// The part of GVCP, the control protocol of GigE Vision, that needs no control over the camera:
// who is there, and reading a register. Each call ends within its time limit, whatever the camera
// does; the full protocol of an open camera is Aravis' business.

// A camera that answered on the network.
struct FoundCamera {
  std::string uri;    // opens it
  std::string model;  // vendor and model
  std::string serial;
  std::string name;     // given by the user, stored in the camera; may be empty
  std::string address;  // IP address
};

// Asks all networks of this machine and collects the answers until `timeout`, or until the camera
// with serial number `wanted` has answered. The order is by address. CANCELLED soon after
// `cancelled` stops.
Result<std::vector<FoundCamera>> DiscoverGevCameras(std::chrono::milliseconds timeout,
                                                    const std::string& wanted = "",
                                                    const std::stop_token& cancelled = {});

// Asks one camera who it is. UNAVAILABLE when it does not answer in time (asked three times).
Result<FoundCamera> IdentifyGevCamera(const std::string& address,
                                      std::chrono::milliseconds timeout);

// Control channel privilege register: 0 when nobody controls the camera.
inline constexpr uint32_t kGevControlPrivilege = 0x0a00;

// UNAVAILABLE when the camera does not answer in time (asked three times).
Result<uint32_t> ReadGevRegister(const std::string& address, uint32_t register_address,
                                 std::chrono::milliseconds timeout);

// The address of this machine from which `address` is reached; INVALID_ARGUMENT when it is no IPv4
// address, UNAVAILABLE when there is no route to it.
Result<std::string> LocalAddressFor(const std::string& address);

// The largest packet, in bytes, of the network interface with this address; 1500 when unknown.
int MtuOf(const std::string& local_address);

}  // namespace vs
