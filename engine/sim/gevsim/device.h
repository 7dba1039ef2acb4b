#pragma once

#include <atomic>
#include <memory>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include "engine/sim/gevsim/acquisition.h"
#include "engine/sim/gevsim/faults.h"
#include "engine/sim/gevsim/gvcp_server.h"
#include "engine/sim/gevsim/registers.h"
#include "engine/sim/gevsim/stream_sender.h"
#include "engine/sim/gevsim/udp_socket.h"
#include "engine/sim/picture_source.h"

namespace vs::sim {

struct DeviceSettings {
  std::string serial_number;
  std::string user_name;
  uint32_t address = 0;  // IPv4, host byte order
  Acquisition::Settings acquisition;
};

// One simulated GigE Vision camera: a Basler acA1300-30gm as far as its registers and packets tell.
class Device final : private GvcpActions {
 public:
  // UNAVAILABLE if the address is not this host's or its GVCP port is taken.
  static Result<std::unique_ptr<Device>> Start(const DeviceSettings& settings,
                                               std::unique_ptr<PictureSource> pictures);
  ~Device() override;

  const DeviceSettings& Settings() const { return settings_; }
  const PictureSource& Pictures() const { return *pictures_; }
  Faults& GetFaults() { return faults_; }
  // An edge on the camera's trigger line. From any thread.
  void OnLine(int64_t instant_ns) { acquisition_.Trigger(TriggerSource::kLine1, instant_ns); }
  // "frames 12 packets 2640 ...": the counters, for people and tests.
  std::string Statistics() const;

 private:
  Device(const DeviceSettings& settings, std::unique_ptr<PictureSource> pictures,
         const DeviceIdentity& identity);
  Status Open(uint32_t broadcast);

  void OnWritten(uint32_t address, uint32_t value) override;
  void OnResend(const ResendRequest& request) override;
  bool OnAction(const ActionCommand& action) override;
  void OnControlEnded(bool silent) override;

  void ServeGvcp();
  void Answer(const UdpSocket& socket);
  void LatchTimestamp();
  Endpoint StreamDestination() const;

  const DeviceSettings settings_;
  std::unique_ptr<PictureSource> pictures_;
  Faults faults_;
  Registers registers_;
  StreamSender sender_{faults_};
  Acquisition acquisition_;
  GvcpServer gvcp_;
  // The first is the device's own address, the others hear broadcasts.
  std::vector<UdpSocket> sockets_;
  std::atomic<uint64_t> silent_clients_ = 0;
  std::atomic<bool> quit_ = false;
  std::thread thread_;
};

}  // namespace vs::sim
