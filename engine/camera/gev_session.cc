#include "engine/camera/gev_session.h"

#include <algorithm>
#include <string_view>
#include <utility>

#include "engine/base/clock.h"
#include "engine/base/str.h"
#include "engine/camera/gvcp.h"

namespace vs {
namespace {

constexpr int kLargestPacketBytes = 8192;
constexpr uint32_t kHeartbeatMs = 3000;
constexpr uint64_t kHeartbeatRegister = 0x0938;
constexpr uint64_t kTimestampControlRegister = 0x0944;
constexpr uint64_t kTimestampHighRegister = 0x0948;
constexpr uint64_t kTimestampLowRegister = 0x094c;
constexpr uint32_t kLatch = 2;

void OnControlLost(ArvDevice* /*device*/, gpointer flag) {
  static_cast<std::atomic<bool>*>(flag)->store(true);
}

void Execute(ArvDevice* device, const char* command) {
  GlibError ignored;
  arv_device_execute_command(device, command, ignored.out());
}

void SetLocked(ArvDevice* device, bool locked) {
  GlibError ignored;
  arv_device_set_integer_feature_value(device, "TLParamsLocked", locked ? 1 : 0, ignored.out());
}

std::vector<UdpSocket> SocketsAt(const std::string& local_address) {
  std::vector<UdpSocket> sockets = UdpSocketsOfThisProcess();
  std::erase_if(sockets, [&](const UdpSocket& one) { return one.address != local_address; });
  return sockets;
}

bool Contains(const std::vector<UdpSocket>& sockets, const UdpSocket& one) {
  return std::ranges::find(sockets, one) != sockets.end();
}

bool TextIs(const Result<FeatureValue>& value, std::string_view text) {
  if (!value) return false;
  const auto* held = std::get_if<std::string>(&*value);
  return held != nullptr && *held == text;
}

}  // namespace

Result<std::unique_ptr<GevSession>> GevSession::Open(const std::string& address) {
  // The interface is chosen by the routing table; Aravis' own choice, the one that a discovery was
  // answered through, may be one on which the stream never arrives.
  VS_ASSIGN_OR_RETURN(const std::string local, LocalAddressFor(address));
  const GObjectPtr<GInetAddress> interface(g_inet_address_new_from_string(local.c_str()));
  const GObjectPtr<GInetAddress> target(g_inet_address_new_from_string(address.c_str()));
  GlibError error;
  GObjectPtr<ArvDevice> device;
  std::vector<UdpSocket> opened;
  {
    // One at a time for another reason, too: Aravis' parser of camera descriptions has global state
    // (0.8.26 crashes when two threads open their first cameras at once).
    MutexLock lock(AravisOpensSockets());
    const std::vector<UdpSocket> before = SocketsAt(local);
    device = GObjectPtr<ArvDevice>(arv_gv_device_new(interface.get(), target.get(), error.out()));
    opened = SocketsAt(local);
    std::erase_if(opened, [&](const UdpSocket& one) { return Contains(before, one); });
  }
  if (error || !device) return error.ToStatus().Annotated("opening");
  if (!arv_gv_device_is_controller(ARV_GV_DEVICE(device.get()))) {
    return FailedPrecondition("another program controls the camera");
  }
  return std::unique_ptr<GevSession>(new GevSession(std::move(device), address, std::move(opened)));
}

GevSession::GevSession(GObjectPtr<ArvDevice> device, std::string address,
                       std::vector<UdpSocket> opened)
    : device_(std::move(device)),
      address_(std::move(address)),
      opened_(std::move(opened)),
      features_(device_.get()) {
  g_signal_connect(device_.get(), "control-lost", G_CALLBACK(OnControlLost), &control_lost_);
  GlibError ignored;
  tick_hz_ =
      arv_gv_device_get_timestamp_tick_frequency(ARV_GV_DEVICE(device_.get()), ignored.out());
}

GevSession::~GevSession() {
  g_signal_handlers_disconnect_by_data(device_.get(), &control_lost_);
  stream_.reset();
}

Status GevSession::Configure(const CameraUri::Options& features, const FeatureMemory& memory) {
  GlibError ignored;
  arv_device_write_register(device_.get(), kHeartbeatRegister, kHeartbeatMs, ignored.out());
  Execute(device_.get(), "AcquisitionStop");  // a controller that crashed may have left it running
  SetLocked(device_.get(), false);
  VS_RETURN_IF_ERROR(SetIfPossible("AcquisitionMode", "Continuous"));
  VS_RETURN_IF_ERROR(SetIfPossible("TriggerSelector", "FrameStart"));
  VS_RETURN_IF_ERROR(SetIfPossible("TriggerMode", "Off"));
  VS_RETURN_IF_ERROR(SetIfPossible("PixelFormat", "Mono8"));
  for (const auto& [name, text] : features) {
    if (const auto set = features_.SetText(name, text); !set) return set.error();
  }
  for (const auto& [name, value] : memory.Replay()) {
    if (const auto set = features_.Set(name, value); !set) return set.error();
  }
  return {};
}

Status GevSession::SetIfPossible(const std::string& name, const std::string& text) {
  if (!features_.Has(name)) return {};
  const auto info = features_.Info(name);
  if (!info || !info->writable || TextIs(features_.Get(name), text)) return {};
  const auto set = features_.SetText(name, text);
  return set ? Status() : set.error();
}

Status GevSession::StartStream(const GevStreamOptions& options, int packet_bytes) {
  VS_RETURN_IF_ERROR(SetPacketSize(packet_bytes));
  VS_ASSIGN_OR_RETURN(stream_, GevStream::Make(device_.get(), options));
  GlibError error;
  // Aravis checks the size with test packets, where the camera can send them, and may lower it.
  packet_bytes_ =
      static_cast<int>(arv_gv_device_get_packet_size(ARV_GV_DEVICE(device_.get()), error.out()));
  SetLocked(device_.get(), true);
  arv_device_execute_command(device_.get(), "AcquisitionStart", error.out());
  if (!error) return {};
  StopStream();
  return error.ToStatus().Annotated("AcquisitionStart");
}

Status GevSession::SetPacketSize(int packet_bytes) {
  if (packet_bytes == 0) {
    VS_ASSIGN_OR_RETURN(const std::string local, LocalAddressFor(address_));
    packet_bytes = std::min(kLargestPacketBytes, MtuOf(local)) / 4 * 4;
  }
  GlibError error;
  arv_gv_device_set_packet_size(ARV_GV_DEVICE(device_.get()), packet_bytes, error.out());
  return error.ToStatus().Annotated(Str("packets of ", packet_bytes, " bytes"));
}

void GevSession::StopStream() {
  Execute(device_.get(), "AcquisitionStop");
  SetLocked(device_.get(), false);
  stream_.reset();
}

void GevSession::Abandon() {
  abandoned_ = true;
  const std::vector<UdpSocket> open = UdpSocketsOfThisProcess();
  std::erase_if(opened_, [&](const UdpSocket& one) { return !Contains(open, one); });
  // Other threads' short-lived sockets are closed by now. If not: better slow than wrong.
  if (opened_.size() == 1) Silence(opened_.front());
}

bool GevSession::Triggered() const { return TextIs(features_.Get("TriggerMode"), "On"); }

Status GevSession::SoftwareTrigger() {
  if (!Triggered()) {
    return FailedPrecondition(
        "the camera runs freely; set TriggerMode=On and "
        "TriggerSource=Software first");
  }
  if (!TextIs(features_.Get("TriggerSource"), "Software")) {
    return FailedPrecondition(
        "the camera waits for a trigger line; set TriggerSource=Software first");
  }
  const auto done = features_.Set("TriggerSoftware", true);
  return done ? Status() : done.error();
}

double GevSession::FirstOf(std::initializer_list<const char*> names) const {
  for (const char* name : names) {
    if (!features_.Has(name)) continue;
    const auto value = features_.Get(name);
    const auto* number = value ? std::get_if<double>(&*value) : nullptr;
    if (number != nullptr) return *number;
  }
  return 0;
}

double GevSession::ExposureUs() const {
  const auto automatic = features_.Get("ExposureAuto");
  if (automatic && !TextIs(automatic, "Off")) return 0;
  return FirstOf({"ExposureTime", "ExposureTimeAbs"});
}

int64_t GevSession::ExpectedPeriodNs() const {
  const double rate_hz = FirstOf({"ResultingFrameRate", "ResultingFrameRateAbs",
                                  "AcquisitionFrameRate", "AcquisitionFrameRateAbs"});
  // A rate that no camera has is none.
  return rate_hz > 1e-3 && rate_hz < 1e6 ? static_cast<int64_t>(1e9 / rate_hz) : 0;
}

bool GevSession::PayloadChanged() const {
  GlibError error;
  const int64_t bytes =
      arv_device_get_integer_feature_value(device_.get(), "PayloadSize", error.out());
  return stream_ != nullptr && !error && bytes != stream_->payload_bytes();
}

std::optional<GevSession::ClockSample> GevSession::SampleClock() {
  GlibError error;
  if (tick_hz_ == 0) return std::nullopt;
  if (!arv_device_write_register(device_.get(), kTimestampControlRegister, kLatch, error.out())) {
    return std::nullopt;
  }
  const int64_t host_ns = SystemClock().MonotonicNs();
  uint32_t high = 0;
  uint32_t low = 0;
  if (!arv_device_read_register(device_.get(), kTimestampHighRegister, &high, error.out()) ||
      !arv_device_read_register(device_.get(), kTimestampLowRegister, &low, error.out())) {
    return std::nullopt;
  }
  const uint64_t ticks = uint64_t{high} << 32 | low;
  if (ticks == 0) return std::nullopt;
  constexpr uint64_t kNsPerS = 1'000'000'000;
  const uint64_t device_ns = ticks / tick_hz_ * kNsPerS + ticks % tick_hz_ * kNsPerS / tick_hz_;
  return ClockSample{static_cast<int64_t>(device_ns), host_ns};
}

}  // namespace vs
