#include "server/vision_watch.h"

#include <chrono>
#include <utility>

#include "engine/base/str.h"
#include "server/sequences/camera_use.h"

namespace vs {
namespace {

constexpr std::chrono::milliseconds kPeriod{500};
constexpr int64_t kClearAfterNs = 5'000'000'000;
constexpr int64_t kOverBudgetNs = 1'000'000'000;

using Severity = AlarmBoard::Severity;

}  // namespace

VisionWatch::VisionWatch(Vision& vision, const gpu::DeviceBoard& gpus, HealthBoard& health,
                         AlarmBoard& alarms, const Clock& clock)
    : vision_(vision), gpus_(gpus), health_(health), alarms_(alarms), clock_(clock) {
  thread_ = std::jthread([this] { Run(); });
}

VisionWatch::~VisionWatch() {
  {
    MutexLock lock(mutex_);
    closing_ = true;
  }
  changed_.NotifyAll();
  thread_.join();
}

void VisionWatch::Run() {
  while (true) {
    Look();
    MutexLock lock(mutex_);
    if (!closing_) changed_.WaitFor(mutex_, kPeriod);
    if (closing_) return;
  }
}

void VisionWatch::Look() {
  if (const Status fault = vision_.results().State().fault; !fault.ok()) {
    Report("results", Severity::kError, Str("results queue in memory: ", fault.message()));
  }
  LookAtSequences();
  LookAtCameras();
  LookAtGpus();
  ClearOld();
}

void VisionWatch::LookAtSequences() {
  std::set<std::string> gone = std::exchange(known_, {});
  for (const SequenceStatus& status : vision_.sequences().List()) {
    const std::string name = "sequences/" + status.id;
    health_.Set(name, status.activity == Activity::kRunning);
    known_.insert(name);
    gone.erase(name);
    LookAtLatency(status);
    if (status.error.empty()) continue;
    const std::string block = status.error_block.empty() ? "" : status.error_block + ": ";
    Report(name, status.activity == Activity::kFault ? Severity::kError : Severity::kWarning,
           Str("sequence ", status.id, ": ", block, status.error));
  }
  for (const std::string& name : gone) health_.Remove(name);
}

void VisionWatch::LookAtLatency(const SequenceStatus& status) {
  const RunStats& stats = status.stats;
  if (!status.active() || stats.latency_budget_ms == 0) {
    latencies_.erase(status.id);
    return;
  }
  Latency& last = latencies_[status.id];
  const bool again = stats.frames < last.frames;  // started anew between two looks
  const bool over = stats.over_budget > (again ? 0 : last.over_budget);
  const int64_t now_ns = clock_.MonotonicNs();
  if (over && last.over_since_ns == 0) last.over_since_ns = now_ns;
  if (!over && stats.frames != last.frames) last.over_since_ns = 0;
  last.frames = stats.frames;
  last.over_budget = stats.over_budget;
  if (last.over_since_ns == 0 || now_ns - last.over_since_ns < kOverBudgetNs) return;
  Report("latency/" + status.id, Severity::kWarning,
         Str("sequence ", status.id, " takes longer than its budget of ", stats.latency_budget_ms,
             " ms: half of the frames need ", stats.latency_p50_ns / 1'000'000, " ms and more; ",
             "lower the rate, give it less to do, or raise latency_budget_ms"));
}

void VisionWatch::LookAtCameras() {
  for (const CameraEntry& camera : vision_.cameras().Cameras()) {
    const std::string trouble = TroubleOf(camera.stats);
    if (trouble.empty() || camera.used_by.empty()) continue;
    Report("cameras/" + camera.id, Severity::kError, Str("camera ", camera.id, ": ", trouble));
  }
}

void VisionWatch::LookAtGpus() {
  for (const gpu::DeviceBoard::Fault& fault : gpus_.Faults()) {
    Report(Str("gpu/", fault.device), Severity::kWarning,
           Str("GPU ", fault.device, " does not work, so ", fault.matchers,
               " matcher(s) work on the processor, more slowly, and try it again each minute: ",
               fault.why.message(),
               "; if this stays, look at the driver's messages (dmesg) and start the server anew"));
  }
}

void VisionWatch::Report(const std::string& id, Severity severity, const std::string& message) {
  alarms_.Raise(id, severity, message);
  reported_ns_[id] = clock_.MonotonicNs();
}

void VisionWatch::ClearOld() {
  const int64_t now_ns = clock_.MonotonicNs();
  std::erase_if(reported_ns_, [&](const auto& entry) {
    if (now_ns - entry.second < kClearAfterNs) return false;
    alarms_.Clear(entry.first);
    return true;
  });
}

}  // namespace vs
