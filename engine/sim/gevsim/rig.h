#pragma once

#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "engine/base/status.h"
#include "engine/sim/gevsim/control_socket.h"
#include "engine/sim/gevsim/device.h"
#include "engine/sim/gevsim/options.h"
#include "engine/sim/gevsim/trigger_line.h"

namespace vs::sim {

// All of gevsim: the cameras, the wire to their trigger inputs, and the socket for commands.
class Rig {
 public:
  // Errors say which camera or option is at fault.
  static Result<std::unique_ptr<Rig>> Start(const Options& options);

  // One line for each camera: "camera 21000001 (left) ready at 127.0.0.1, 1296 x 966 px".
  std::vector<std::string> Greeting() const;

  // Carries out a command and gives the answer to it:
  //   [left|right] FAULT ...   see Faults::Apply; both cameras if none is named
  //   trigger                  one pulse on the line
  //   stats                    the counters of each camera
  Result<std::string> Command(std::string_view command);

 private:
  Rig() = default;

  struct NamedDevice {
    std::string name;
    std::unique_ptr<Device> device;
  };
  std::vector<NamedDevice> devices_;
  // After the cameras, so that they stop before the cameras go.
  std::optional<TriggerLine> line_;
  std::unique_ptr<ControlSocket> control_;
};

}  // namespace vs::sim
