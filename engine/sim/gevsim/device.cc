#include "engine/sim/gevsim/device.h"

#include <poll.h>
#include <sys/prctl.h>

#include <array>
#include <chrono>

#include "engine/base/clock.h"
#include "engine/base/str.h"
#include "engine/sim/gevsim/camera_xml.h"

namespace vs::sim {
namespace {

int64_t Now() { return SystemClock().MonotonicNs(); }

constexpr uint32_t kEverybody = 0xffffffff;  // 255.255.255.255

}  // namespace

Result<std::unique_ptr<Device>> Device::Start(const DeviceSettings& settings,
                                              std::unique_ptr<PictureSource> pictures) {
  const Network network = FindNetwork(settings.address);
  const DeviceIdentity identity = {.serial_number = settings.serial_number,
                                   .user_name = settings.user_name,
                                   .address = settings.address,
                                   .subnet_mask = network.mask,
                                   .sensor_width = pictures->width(),
                                   .sensor_height = pictures->height(),
                                   .tick_hz = settings.acquisition.clock.tick_hz};
  std::unique_ptr<Device> device(new Device(settings, std::move(pictures), identity));
  VS_RETURN_IF_ERROR(device->Open(network.broadcast).Annotated("camera " + settings.serial_number));
  return device;
}

Device::Device(const DeviceSettings& settings, std::unique_ptr<PictureSource> pictures,
               const DeviceIdentity& identity)
    : settings_(settings),
      pictures_(std::move(pictures)),
      registers_(identity, kCameraXml),
      acquisition_(settings.acquisition, registers_, *pictures_, sender_, faults_),
      gvcp_(registers_, *this) {}

Device::~Device() {
  quit_ = true;
  if (thread_.joinable()) thread_.join();
}

Status Device::Open(uint32_t broadcast) {
  VS_ASSIGN_OR_RETURN(UdpSocket own, UdpSocket::Bind({settings_.address, kGvcpPort}));
  sockets_.push_back(std::move(own));
  // Whoever looks for cameras without knowing their addresses asks everybody. A host that cannot
  // hear that is still a camera for those who know its address.
  for (const uint32_t address : {kEverybody, broadcast}) {
    if (address == 0) continue;
    auto ear = UdpSocket::Bind({address, kGvcpPort}, true);
    if (ear) sockets_.push_back(std::move(*ear));
  }
  VS_RETURN_IF_ERROR(sender_.Open(settings_.address));
  registers_.Set(reg::kStreamSourcePort, sender_.LocalPort());
  thread_ = std::thread([this] { ServeGvcp(); });
  return {};
}

void Device::ServeGvcp() {
  prctl(PR_SET_NAME, "gevsim-control");
  std::vector<pollfd> waiting;
  for (const UdpSocket& socket : sockets_) waiting.push_back({socket.fd(), POLLIN, 0});
  while (!quit_) {
    constexpr int kTickMs = 50;
    poll(waiting.data(), waiting.size(), kTickMs);
    for (size_t i = 0; i < waiting.size(); ++i) {
      if ((waiting[i].revents & POLLIN) != 0) Answer(sockets_[i]);
    }
    gvcp_.Tick(Now());
  }
}

void Device::Answer(const UdpSocket& socket) {
  std::array<uint8_t, 1024> bytes;
  Endpoint client;
  const int count = socket.Receive(bytes, &client);
  const FaultSettings faults = faults_.Get();
  if (count == 0 || faults.unplugged) return;
  const auto answer =
      gvcp_.Handle(std::span(bytes).first(static_cast<size_t>(count)), client, Now());
  if (answer.empty()) return;
  if (faults.slow_answer_ms > 0) {
    std::this_thread::sleep_for(std::chrono::milliseconds(faults.slow_answer_ms));
  }
  // Always from the device's own address, also when everybody was asked.
  sockets_.front().Send(answer, client);
}

void Device::OnWritten(uint32_t address, uint32_t value) {
  switch (address) {
    case reg::kAcquisitionStart:
      if (value == 1) acquisition_.Start();
      break;
    case reg::kAcquisitionStop:
      if (value == 1) acquisition_.Stop();
      break;
    case reg::kTriggerSoftware:
      if (value == 1) acquisition_.Trigger(TriggerSource::kSoftware, Now());
      break;
    case reg::kTimestampControl:
      if ((value & kTimestampLatch) != 0) LatchTimestamp();
      break;
    case reg::kStreamPort:
      acquisition_.RestartBlockIds();
      break;
    case reg::kStreamPacketSize:
      registers_.Set(address, value & ~kTestPacketFlag);
      if ((value & kTestPacketFlag) != 0) {
        sender_.SendTestPacket(static_cast<int>(value & kStreamPacketSizeMask),
                               StreamDestination());
      }
      break;
    default:
      break;
  }
}

void Device::OnResend(const ResendRequest& request) {
  sender_.Resend(request, StreamDestination());
}

bool Device::OnAction(const ActionCommand& action) {
  const bool meant = action.device_key == registers_.Get(reg::kActionDeviceKey) &&
                     action.group_key == registers_.Get(reg::kActionGroupKey) &&
                     (action.group_mask & registers_.Get(reg::kActionGroupMask)) != 0;
  if (!meant) return true;
  const int64_t now_ns = Now();
  const int64_t instant_ns =
      action.at_ticks ? settings_.acquisition.clock.InstantOfTicks(*action.at_ticks) : now_ns;
  if (instant_ns < now_ns) return false;
  acquisition_.Trigger(TriggerSource::kAction1, instant_ns);
  return true;
}

void Device::OnControlEnded(bool silent) {
  if (silent) ++silent_clients_;
  acquisition_.Stop();
  registers_.Set(reg::kStreamPort, 0);
  registers_.Set(reg::kStreamDestination, 0);
}

void Device::LatchTimestamp() {
  const uint64_t ticks = settings_.acquisition.clock.TicksAt(Now());
  registers_.Set(reg::kTimestampHigh, static_cast<uint32_t>(ticks >> 32));
  registers_.Set(reg::kTimestampLow, static_cast<uint32_t>(ticks));
}

Endpoint Device::StreamDestination() const {
  return {registers_.Get(reg::kStreamDestination),
          static_cast<uint16_t>(registers_.Get(reg::kStreamPort))};
}

std::string Device::Statistics() const {
  const StreamCounters& c = sender_.Counters();
  return Str("frames ", c.frames, " packets ", c.packets, " resent ", c.resent, " unavailable ",
             c.unavailable, " dropped-packets ", c.dropped_packets, " dropped-frames ",
             c.dropped_frames, " missed-triggers ", acquisition_.MissedTriggers(),
             " silent-clients ", silent_clients_);
}

}  // namespace vs::sim
