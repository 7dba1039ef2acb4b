#include "engine/sim/gevsim/acquisition.h"

#include <sys/prctl.h>

#include <algorithm>
#include <chrono>

#include "engine/base/clock.h"

namespace vs::sim {
namespace {

int64_t Now() { return SystemClock().MonotonicNs(); }

// A real camera holds about as many.
constexpr size_t kTriggersHeld = 2;

}  // namespace

Acquisition::Acquisition(const Settings& settings, Registers& registers, PictureSource& pictures,
                         StreamSender& sender, Faults& faults)
    : settings_(settings),
      registers_(registers),
      pictures_(pictures),
      sender_(sender),
      faults_(faults),
      block_id_(settings.first_block_id),
      thread_([this] { Run(); }) {}

Acquisition::~Acquisition() {
  halt_ = true;
  {
    MutexLock lock(mutex_);
    quit_ = true;
    changed_.NotifyAll();
  }
  thread_.join();
}

void Acquisition::Start() {
  registers_.Set(reg::kAcquisitionActive, 1);
  MutexLock lock(mutex_);
  if (running_) return;
  running_ = true;
  triggers_.clear();
  next_free_run_ns_ = Now();
  changed_.NotifyAll();
}

void Acquisition::Stop() {
  MutexLock lock(mutex_);
  running_ = false;
  registers_.Set(reg::kAcquisitionActive, 0);
}

void Acquisition::RestartBlockIds() { block_id_ = settings_.first_block_id; }

void Acquisition::Trigger(TriggerSource source, int64_t instant_ns) {
  if (!TriggerOn(source)) return;
  MutexLock lock(mutex_);
  if (!running_) return;
  if (triggers_.size() >= kTriggersHeld) {
    ++missed_triggers_;
    return;
  }
  triggers_.push_back(instant_ns);
  changed_.NotifyAll();
}

bool Acquisition::TriggerOn(TriggerSource source) const {
  return registers_.Get(reg::kTriggerMode) == 1 &&
         registers_.Get(reg::kTriggerSource) == static_cast<uint32_t>(source);
}

bool Acquisition::FreeRunning() const { return registers_.Get(reg::kTriggerMode) == 0; }

void Acquisition::Run() {
  prctl(PR_SET_NAME, "gevsim-camera");
  prctl(PR_SET_TIMERSLACK, 1000);
  while (true) {
    {
      MutexLock lock(mutex_);
      if (quit_) return;
    }
    if (const auto instant_ns = NextInstant()) TakePicture(*instant_ns);
  }
}

std::optional<int64_t> Acquisition::NextInstant() {
  MutexLock lock(mutex_);
  const int64_t now_ns = Now();
  int64_t due_ns = now_ns + 100'000'000;
  if (running_ && FreeRunning()) {
    // Late by more than a picture: leave pictures out rather than hurry after them.
    const int64_t period_ns = registers_.PeriodNs();
    if (next_free_run_ns_ + period_ns < now_ns) {
      next_free_run_ns_ += (now_ns - next_free_run_ns_) / period_ns * period_ns;
    }
    due_ns = next_free_run_ns_;
    if (due_ns <= now_ns) {
      next_free_run_ns_ += period_ns;
      return due_ns;
    }
  } else if (running_ && !triggers_.empty()) {
    due_ns = triggers_.front();
    if (due_ns <= now_ns) {
      triggers_.pop_front();
      return due_ns;
    }
  }
  changed_.WaitFor(mutex_, std::chrono::nanoseconds(due_ns - now_ns));
  return std::nullopt;
}

void Acquisition::TakePicture(int64_t instant_ns) {
  const FaultSettings faults = faults_.Get();
  if (instant_ns < faults.frozen_until_ns) {
    ++missed_triggers_;
    return;
  }
  const SensorSettings sensor = registers_.Sensor();
  auto frame = std::make_shared<GvspFrame>();
  frame->block_id = block_id_;
  block_id_ = block_id_ == 0xffff ? 1 : block_id_ + 1;
  frame->ticks = settings_.clock.TicksAt(instant_ns);
  frame->offset_x = sensor.offset_x;
  frame->offset_y = sensor.offset_y;
  frame->picture = GreyImage(pool_, sensor.width, sensor.height);
  frame->packet_bytes =
      std::clamp(static_cast<int>(registers_.Get(reg::kStreamPacketSize) & kStreamPacketSizeMask),
                 kMinPacketBytes, kMaxPacketBytes);
  if (faults.wrong_type_every > 0 && ++frames_ % faults.wrong_type_every == 0) {
    frame->payload_type = static_cast<uint16_t>(faults.wrong_type);
  }
  if (faults.black) {
    frame->picture.Fill(0);
  } else {
    pictures_.Capture(settings_.clock.InstantOfTicks(frame->ticks), sensor, frame->picture);
  }
  const Endpoint to = {registers_.Get(reg::kStreamDestination),
                       static_cast<uint16_t>(registers_.Get(reg::kStreamPort))};
  const int64_t delay_ns =
      int64_t{registers_.Get(reg::kStreamPacketDelay)} * 1'000'000'000 / settings_.clock.tick_hz;
  if (to.port != 0) sender_.Send(frame, to, {settings_.link_mbps, delay_ns}, halt_);
  if (registers_.Get(reg::kAcquisitionMode) ==
      static_cast<uint32_t>(AcquisitionMode::kSingleFrame)) {
    Stop();
  }
}

}  // namespace vs::sim
