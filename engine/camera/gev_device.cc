#include "engine/camera/gev_device.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "engine/base/log.h"
#include "engine/base/str.h"

namespace vs {
namespace {

using std::chrono::milliseconds;

constexpr milliseconds kFirstRetry{250};
constexpr milliseconds kLastRetry{2000};
// While another program has control it may let go any moment. If it crashed, the camera waits for
// its heartbeat, and some cameras take each of our questions for one: so now and then ask nothing
// for longer than a heartbeat.
constexpr milliseconds kRetryForControl{500};
constexpr milliseconds kQuietForControl{3500};
constexpr int kQuietEvery = 10;
// A call, which is not tried again, waits a moment for control: often it is our own last call that
// is just being closed.
constexpr milliseconds kControlPatience{2000};
constexpr milliseconds kControlPoll{50};
constexpr milliseconds kSearchTime{500};
constexpr milliseconds kAskTime{150};
constexpr milliseconds kPopTime{10};
constexpr milliseconds kCallBudget{5};
constexpr milliseconds kIdleSleep{50};
constexpr milliseconds kClosedSleep{1000};
constexpr int64_t kHousekeepingNs = 1'000'000'000;
constexpr int64_t kStallGraceNs = 100'000'000;
constexpr int kSmallPacketBytes = 1500;
constexpr char kSilent[] = "the camera does not answer any more; check its power and cable";

}  // namespace

GevDevice::GevDevice(GevCameraOptions options)
    : options_(std::move(options)), thread_([this] { Run(); }) {}

GevDevice::~GevDevice() {
  quit_ = true;
  calls_.Poke();
  thread_.join();
}

Status GevDevice::Start(FrameSink sink) {
  MutexLock lock(sink_mutex_);
  if (sink_) return FailedPrecondition(Str("camera ", options_.uri, " is already streaming"));
  sink_ = std::move(sink);
  streaming_wanted_ = true;
  calls_.Poke();
  return {};
}

void GevDevice::Stop() {
  streaming_wanted_ = false;
  MutexLock lock(sink_mutex_);
  sink_ = nullptr;
  calls_.Poke();
}

CameraStats GevDevice::Stats() const {
  MutexLock lock(stats_mutex_);
  CameraStats stats = stats_;
  if (stats.state == CameraState::kStreaming && clock_.MonotonicNs() > stall_ns_) {
    stats.state = CameraState::kStalled;
  }
  if (stats.state != CameraState::kStreaming) stats.frames_per_second = 0;
  return stats;
}

void GevDevice::Run() {
  milliseconds retry = kFirstRetry;
  while (!quit_) {
    if (!Needed()) {
      SetState(CameraState::kClosed, "");
      calls_.AdmitOpening();
      calls_.Sleep(kClosedSleep);
      continue;
    }
    if (state() == CameraState::kClosed) SetState(CameraState::kOpening, "");
    const uint64_t frames_before = receiver_.counters().frames;
    Status status = Open();
    const bool opened = status.ok();
    if (opened) status = Serve();
    if (receiver_.counters().frames != frames_before) retry = kFirstRetry;
    if (!quit_) {
      LogProblem(opened ? Str("lost: ", status.message()) : status.message());
      calls_.Refuse(status);
      SetState(opened ? CameraState::kLost : CameraState::kOpening, status.message());
    }
    Close();
    if (!streaming_wanted_) continue;
    if (status.code() == StatusCode::kFailedPrecondition) {
      const bool quiet = ++refusals_ % kQuietEvery == 0;
      SleepUnlessQuit(quiet ? kQuietForControl : kRetryForControl);
    } else {
      refusals_ = 0;
      SleepUnlessQuit(retry);
      retry = std::min(2 * retry, kLastRetry);
    }
  }
}

// The same problem is told once, however often it is met while trying.
void GevDevice::LogProblem(const std::string& problem) {
  if (problem == logged_problem_) return;
  logged_problem_ = problem;
  LogWarn("camera", Str(options_.uri, ": ", problem));
}

void GevDevice::SleepUnlessQuit(milliseconds duration) {
  const auto deadline = std::chrono::steady_clock::now() + duration;
  while (!quit_ && streaming_wanted_) {
    const auto left = std::chrono::ceil<milliseconds>(deadline - std::chrono::steady_clock::now());
    if (left.count() <= 0) return;
    calls_.Sleep(left);
  }
}

Result<FoundCamera> GevDevice::Locate() {
  if (!options_.address.empty()) return IdentifyGevCamera(options_.address, kSearchTime);
  if (!camera_.address.empty()) {
    auto known = IdentifyGevCamera(camera_.address, kSearchTime);
    if (known && known->serial == options_.serial) return known;
  }
  VS_ASSIGN_OR_RETURN(const std::vector<FoundCamera> cameras,
                      DiscoverGevCameras(kSearchTime, options_.serial));
  std::string others;
  for (const FoundCamera& camera : cameras) {
    if (camera.serial == options_.serial) return camera;
    others += (others.empty() ? "; those that answer: " : ", ") + camera.serial;
  }
  return Unavailable(Str("no camera with serial number ", options_.serial,
                         " answers; check its power and cable", others));
}

Status GevDevice::Open() {
  VS_ASSIGN_OR_RETURN(camera_, Locate());
  VS_RETURN_IF_ERROR(AwaitControl());
  VS_ASSIGN_OR_RETURN(session_, GevSession::Open(camera_.address));
  VS_RETURN_IF_ERROR(session_->Configure(options_.features, memory_));
  NoteSettings();
  logged_problem_.clear();
  const bool again = std::exchange(opened_before_, true);
  {
    MutexLock lock(stats_mutex_);
    stats_.model = camera_.model;
    stats_.serial = camera_.serial;
    if (again) ++stats_.reconnects;
  }
  SetState(CameraState::kIdle, "");
  calls_.AdmitOpen();
  LogInfo("camera", Str(options_.uri, again ? " open again: " : " open: ", camera_.model,
                        ", serial ", camera_.serial, ", at ", camera_.address));
  return {};
}

Status GevDevice::AwaitControl() {
  const auto deadline = std::chrono::steady_clock::now() + kControlPatience;
  while (true) {
    VS_ASSIGN_OR_RETURN(const uint32_t privilege,
                        ReadGevRegister(camera_.address, kGevControlPrivilege, kSearchTime));
    if (privilege == 0) return {};
    if (quit_ || streaming_wanted_ || std::chrono::steady_clock::now() >= deadline) break;
    std::this_thread::sleep_for(kControlPoll);
  }
  return FailedPrecondition(Str("another program controls the camera at ", camera_.address,
                                "; waiting until it lets go or its heartbeat stops"));
}

Status GevDevice::Serve() {
  while (!quit_) {
    const bool wanted = streaming_wanted_;
    if (wanted && session_->stream() == nullptr) {
      VS_RETURN_IF_ERROR(BeginStream());
    } else if (!wanted && session_->stream() != nullptr) {
      EndStream();
      SetState(CameraState::kIdle, "");
    }
    calls_.Run(*this, kCallBudget);
    if (session_->abandoned()) return Unavailable(kSilent);
    if (session_->control_lost()) {
      return Unavailable("the camera restarted, or another program took control of it");
    }
    if (session_->stream() != nullptr) {
      VS_RETURN_IF_ERROR(Receive());
    } else {
      calls_.Sleep(kIdleSleep);
    }
  }
  return {};
}

Status GevDevice::BeginStream() {
  receiver_.Restart(camera_.serial.empty() ? camera_.address : camera_.serial, *session_);
  const int packet_bytes = small_packets_ ? kSmallPacketBytes : options_.packet_bytes;
  VS_RETURN_IF_ERROR(session_->StartStream(options_.stream, packet_bytes));
  counted_ = {};
  starving_ = false;
  socket_checked_ = false;
  watchdog_.Restart(clock_.MonotonicNs(), session_->Triggered(), session_->ExpectedPeriodNs());
  {
    MutexLock lock(stats_mutex_);
    stats_.packet_bytes = session_->packet_bytes();
    stats_.socket_buffer_asked_bytes = options_.stream.socket_buffer_bytes;
    stall_ns_ = watchdog_.quiet_until_ns() + kStallGraceNs;
  }
  SetState(CameraState::kStreaming, "");
  return {};
}

void GevDevice::EndStream() {
  if (session_->stream() == nullptr) return;
  AbandonIfGone();
  CountStream();
  session_->StopStream();
}

void GevDevice::Close() {
  if (session_ == nullptr) return;
  EndStream();
  AbandonIfGone();
  session_.reset();
}

void GevDevice::AbandonIfGone() {
  if (session_->abandoned()) return;
  if (!ReadGevRegister(camera_.address, kGevControlPrivilege, kSearchTime)) session_->Abandon();
}

Status GevDevice::Receive() {
  auto picture = session_->stream()->Pop(kPopTime);
  const int64_t now_ns = clock_.MonotonicNs();
  if (picture) {
    FramePtr frame = receiver_.Take(std::move(*picture), now_ns);
    CountPictures();
    if (frame != nullptr) {
      starving_ = false;
      watchdog_.Picture(now_ns, receiver_.period_ns());
      {
        MutexLock lock(sink_mutex_);
        if (sink_) sink_(std::move(frame));
      }
      SynchroniseClocks(now_ns);
    }
  } else {
    CountStream();
  }
  KeepHouse(now_ns);
  return Watch(now_ns);
}

Status GevDevice::Watch(int64_t now_ns) {
  switch (watchdog_.Check(now_ns)) {
    case GevWatchdog::Action::kNone:
      break;
    case GevWatchdog::Action::kAsk:
      VS_RETURN_IF_ERROR(Ask(now_ns));
      break;
    case GevWatchdog::Action::kLostSilent:
      return Unavailable(kSilent);
    case GevWatchdog::Action::kLostIdle:
      if (receiver_.incomplete_in_a_row() > 0 && options_.packet_bytes == 0 && !small_packets_) {
        small_packets_ = true;
        return Unavailable(Str("no picture arrived whole with packets of ",
                               session_->packet_bytes(), " bytes; trying ", kSmallPacketBytes,
                               ": set the same MTU on all network devices on the way"));
      }
      return Unavailable("the camera answers but sends no pictures");
  }
  {
    MutexLock lock(stats_mutex_);
    stall_ns_ = watchdog_.quiet_until_ns() + kStallGraceNs;
  }
  const CameraState now = watchdog_.stalled() ? CameraState::kStalled : CameraState::kStreaming;
  if (now == state()) return {};
  if (now == CameraState::kStalled) {
    const std::string problem = receiver_.incomplete_in_a_row() > 0
                                    ? "no picture arrives whole: " + receiver_.problem()
                                    : "no pictures come";
    LogWarn("camera", Str(options_.uri, " stalled: ", problem));
    SetState(now, problem);
  } else {
    calls_.AdmitOpen();
    LogInfo("camera", options_.uri + " streams again");
    SetState(now, "");
  }
  return {};
}

Status GevDevice::Ask(int64_t now_ns) {
  const auto privilege = ReadGevRegister(camera_.address, kGevControlPrivilege, kAskTime);
  if (!privilege) {
    watchdog_.NotAnswered(now_ns);
    calls_.Refuse(privilege.error());
  } else if (*privilege == 0) {
    return Unavailable("the camera restarted: it has no controller any more");
  } else {
    watchdog_.Answered(now_ns);
    calls_.AdmitOpen();
    SynchroniseClocks(now_ns);
  }
  return {};
}

Result<FeatureValue> GevDevice::SetFeature(const std::string& name, const FeatureValue& value) {
  VS_ASSIGN_OR_RETURN(const FeatureInfo info, features().Info(name));
  const bool command = info.type == FeatureInfo::Type::kCommand;
  if (!info.writable && session_->stream() != nullptr && features().Locked(name)) EndStream();
  VS_ASSIGN_OR_RETURN(FeatureValue set, features().Set(name, value));
  if (!command) memory_.Remember(name, value);
  // Serve opens the stream again, with the new size of pictures.
  if (session_->PayloadChanged()) EndStream();
  NoteSettings();
  return set;
}

void GevDevice::NoteSettings() {
  receiver_.SetExposure(session_->ExposureUs());
  watchdog_.Restart(clock_.MonotonicNs(), session_->Triggered(), session_->ExpectedPeriodNs());
}

void GevDevice::CountPictures() {
  const GevReceiver::Counters& counters = receiver_.counters();
  MutexLock lock(stats_mutex_);
  stats_.frames = counters.frames;
  stats_.incomplete = counters.incomplete;
  stats_.rejected_stale = counters.rejected_stale;
  stats_.lost = counters.lost;
}

void GevDevice::CountStream() {
  const GevStreamCounters now = session_->stream()->Counters();
  const bool starves = now.underruns != counted_.underruns;
  if (starves) watchdog_.Starving(clock_.MonotonicNs());
  const bool begins_to_starve = starves && !std::exchange(starving_, starves);
  MutexLock lock(stats_mutex_);
  if (begins_to_starve) {
    ++stats_.underruns;
    stats_.last_error = Str("no free buffer: all ", options_.stream.buffers,
                            " pictures are held by the sequence; make it faster or give the camera "
                            "more (buffers=N)");
  }
  stats_.resend_requests += now.resend_requests - counted_.resend_requests;
  stats_.resent += now.resent - counted_.resent;
  counted_ = now;
}

void GevDevice::KeepHouse(int64_t now_ns) {
  if (now_ns < next_housekeeping_ns_) return;
  next_housekeeping_ns_ = now_ns + kHousekeepingNs;
  CountStream();
  CheckSocketBuffer();
  const uint64_t frames = receiver_.counters().frames;
  const double elapsed_s = static_cast<double>(now_ns - last_housekeeping_ns_) * 1e-9;
  MutexLock lock(stats_mutex_);
  if (stats_.state == CameraState::kStreaming && !starving_) stats_.last_error.clear();
  stats_.frames_per_second = static_cast<double>(frames - last_frames_) / elapsed_s;
  last_frames_ = frames;
  last_housekeeping_ns_ = now_ns;
}

// Called when the camera was just heard: of one that may be gone the answer could take seconds.
void GevDevice::SynchroniseClocks(int64_t now_ns) {
  if (now_ns < next_synchronisation_ns_) return;
  next_synchronisation_ns_ = now_ns + kHousekeepingNs;
  receiver_.SynchroniseClocks(*session_);
}

void GevDevice::CheckSocketBuffer() {
  if (socket_checked_ || counted_.resend_requests + receiver_.counters().frames == 0) return;
  socket_checked_ = true;
  const int asked_bytes = options_.stream.socket_buffer_bytes;
  const int got_bytes = session_->stream()->SocketBufferBytes();
  const bool known = got_bytes > 0;
  if (known && got_bytes < asked_bytes && !std::exchange(socket_warned_, true)) {
    LogWarn("camera", Str(options_.uri, ": the system gave its socket a buffer of ", got_bytes,
                          " bytes instead of ", asked_bytes,
                          ", so pictures may be lost; raise net.core.rmem_max, for example "
                          "sysctl -w net.core.rmem_max=8388608"));
  }
  MutexLock lock(stats_mutex_);
  stats_.socket_buffer_got_bytes = got_bytes;
}

void GevDevice::SetState(CameraState state, const std::string& problem) {
  MutexLock lock(stats_mutex_);
  stats_.state = state;
  stats_.last_error = problem;
}

CameraState GevDevice::state() const {
  MutexLock lock(stats_mutex_);
  return stats_.state;
}

}  // namespace vs
