#include "engine/camera/gev_receiver.h"

#include <algorithm>
#include <memory>
#include <utility>

namespace vs {
namespace {

constexpr int kFirstClockSamples = 3;
constexpr int64_t kClockErrorNs = 1'000'000;          // more than that is no measurement noise
constexpr int64_t kOldestPictureNs = 10'000'000'000;  // still believable on arrival

}  // namespace

void GevReceiver::Restart(const std::string& camera, GevSession& session) {
  camera_ = camera;
  guard_.Restart();
  mapper_.Reset();
  last_timestamp_ns_ = 0;
  period_ns_ = 0;
  incomplete_in_a_row_ = 0;
  clock_latches_ = true;
  for (int i = 0; i < kFirstClockSamples && clock_latches_; ++i) SynchroniseClocks(session);
}

void GevReceiver::SynchroniseClocks(GevSession& session) {
  if (!clock_latches_) return;
  if (const auto sample = session.SampleClock()) {
    mapper_.Add(sample->device_ns, sample->host_ns);
  } else {
    clock_latches_ = false;
  }
}

FramePtr GevReceiver::Take(GevPicture picture, int64_t arrival_ns) {
  switch (picture.kind) {
    case GevPicture::Kind::kAborted:
      return nullptr;
    case GevPicture::Kind::kRecycled:
      ++counters_.rejected_stale;
      return nullptr;
    case GevPicture::Kind::kIncomplete:
      ++counters_.incomplete;
      ++incomplete_in_a_row_;
      problem_ = picture.problem;
      return nullptr;
    case GevPicture::Kind::kWhole:
      break;
  }
  const GevFrameGuard::Verdict verdict = guard_.Check(picture.frame_id, picture.timestamp_ns);
  if (!verdict.fresh) {
    ++counters_.rejected_stale;
    return nullptr;
  }
  if (verdict.clock_restarted) mapper_.Reset();
  NotePeriod(picture.timestamp_ns, verdict.lost == 0 && !verdict.clock_restarted);
  ++counters_.frames;
  counters_.lost += verdict.lost;
  incomplete_in_a_row_ = 0;
  return MakeFrame(std::move(picture), verdict.number, arrival_ns);
}

FramePtr GevReceiver::MakeFrame(GevPicture picture, uint64_t number, int64_t arrival_ns) {
  auto frame = std::allocate_shared<Frame>(memory_);
  frame->camera = camera_;
  frame->number = number;
  frame->timestamp_ns = picture.timestamp_ns;
  frame->capture_ns = CaptureNs(picture, arrival_ns);
  frame->arrival_ns = arrival_ns;
  frame->exposure_us = exposure_us_;
  frame->image = std::move(picture.image);
  return frame;
}

int64_t GevReceiver::CaptureNs(const GevPicture& picture, int64_t arrival_ns) {
  // A step of the system's time between the two readings must not make the age absurd.
  const int64_t leader_ns =
      arrival_ns - std::clamp<int64_t>(picture.leader_age_ns, 0, kOldestPictureNs);
  if (picture.timestamp_ns == 0) return leader_ns;
  if (!clock_latches_ || !mapper_.known()) mapper_.Add(picture.timestamp_ns, leader_ns);
  int64_t capture_ns = mapper_.HostNs(picture.timestamp_ns);
  if (capture_ns > arrival_ns + kClockErrorNs || capture_ns < arrival_ns - kOldestPictureNs) {
    // The clock that can be read is not the one that stamps the pictures, or it was reset.
    clock_latches_ = false;
    mapper_.Reset();
    mapper_.Add(picture.timestamp_ns, leader_ns);
    capture_ns = leader_ns;
  }
  return std::min(capture_ns, arrival_ns);
}

void GevReceiver::NotePeriod(int64_t timestamp_ns, bool successor) {
  const int64_t interval_ns = timestamp_ns - std::exchange(last_timestamp_ns_, timestamp_ns);
  if (!successor || interval_ns <= 0 || interval_ns == timestamp_ns) return;
  period_ns_ = period_ns_ == 0 ? interval_ns : (7 * period_ns_ + interval_ns) / 8;
}

}  // namespace vs
