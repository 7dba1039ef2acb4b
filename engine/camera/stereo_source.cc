#include "engine/camera/stereo_source.h"

#include <optional>
#include <utility>

#include "engine/base/mutex.h"
#include "engine/base/recycler.h"
#include "engine/base/str.h"

namespace vs {
namespace {

// So many pictures without a partner in a row are no accident any more.
constexpr uint64_t kManyAlone = 3 * Pairer::kDepth;

// Why two cameras that are well make no pairs; empty when they do.
std::string PairingProblem(const PairStats& pairing) {
  if (pairing.left_alone + pairing.right_alone < kManyAlone) return "";
  if (pairing.right_alone == 0) {
    return "right camera: no pictures come while the left one takes some; check its trigger";
  }
  if (pairing.left_alone == 0) {
    return "left camera: no pictures come while the right one takes some; check its trigger";
  }
  return "no picture of the left camera was taken at the same time as one of the right; trigger "
         "both together, or allow a larger tolerance";
}

void AddUnpaired(const std::string& side, const Unpaired& unpaired, SourceReport* report) {
  const auto add = [&](const char* reason, uint64_t count) {
    report->readings.push_back({side + reason, static_cast<int64_t>(count)});
  };
  add("_no_counterpart", unpaired.no_counterpart);
  add("_overflow", unpaired.overflow);
  add("_out_of_order", unpaired.out_of_order);
}

double ToMs(int64_t ns) { return static_cast<double>(ns) * 1e-6; }

class CameraPair final : public StereoSource {
 public:
  CameraPair(std::shared_ptr<CameraSource> left, std::shared_ptr<CameraSource> right,
             PairerOptions options)
      : left_(std::move(left)),
        right_(std::move(right)),
        recorded_(left_->Recorded() && right_->Recorded()),
        pairer_(options) {}
  ~CameraPair() override { Stop(); }

  Status Start(StereoSink sink) override {
    {
      MutexLock order(order_mutex_);
      sink_ = std::move(sink);
    }
    {
      MutexLock lock(mutex_);
      stopping_ = false;
    }
    if (Status status = StartSide(*left_, Side::kLeft); !status.ok()) {
      return status.Annotated("left camera");
    }
    if (Status status = StartSide(*right_, Side::kRight); !status.ok()) {
      Stop();
      return status.Annotated("right camera");
    }
    return {};
  }

  void Stop() override {
    {
      MutexLock lock(mutex_);
      stopping_ = true;
      room_.NotifyAll();
    }
    left_->Stop();
    right_->Stop();
  }

  StereoStats Stats() const override {
    StereoStats stats;
    stats.left = left_->Stats();
    stats.right = right_->Stats();
    MutexLock lock(mutex_);
    stats.pairing = pairer_.Stats();
    return stats;
  }

  bool Recorded() const override { return recorded_; }

 private:
  Status StartSide(CameraSource& camera, Side side) {
    return camera.Start([this, side](FramePtr frame) { Take(side, std::move(frame)); });
  }

  void Take(Side side, FramePtr frame) {
    if (recorded_ && !WaitForRoom(side)) return;
    MutexLock order(order_mutex_);
    std::optional<StereoFrame> pair;
    {
      MutexLock lock(mutex_);
      pair = pairer_.Add(side, std::move(frame));
      room_.NotifyAll();
    }
    if (pair) sink_(std::allocate_shared<StereoFrame>(memory_, std::move(*pair)));
  }

  // Of two recorded cameras, the faster one waits, so that none of its pictures is dropped.
  bool WaitForRoom(Side side) {
    MutexLock lock(mutex_);
    while (!stopping_ && pairer_.Waiting(side) == Pairer::kDepth) room_.Wait(mutex_);
    return !stopping_;
  }

  const std::shared_ptr<CameraSource> left_;
  const std::shared_ptr<CameraSource> right_;
  const bool recorded_;
  Recycler<StereoFrame> memory_;

  Mutex order_mutex_;  // held while a pair is handed on, so that pairs leave in order
  StereoSink sink_ VS_GUARDED_BY(order_mutex_);

  mutable Mutex mutex_;  // may be taken with order_mutex_ held
  CondVar room_;
  Pairer pairer_ VS_GUARDED_BY(mutex_);
  bool stopping_ VS_GUARDED_BY(mutex_) = false;
};

}  // namespace

SourceReport ReportOf(const StereoStats& stats) {
  SourceReport report;
  for (const auto& [side, camera] : {std::pair("left", &stats.left), {"right", &stats.right}}) {
    SourceReport one = ReportOf(*camera);
    if (!one.problem.empty() && report.problem.empty()) {
      report.problem = Str(side, " camera: ", one.problem);
    }
    for (Reading& reading : one.readings) {
      report.readings.push_back({Str(side, "_", reading.name), std::move(reading.value)});
    }
  }
  const PairStats& pairing = stats.pairing;
  if (report.problem.empty()) report.problem = PairingProblem(pairing);
  report.readings.push_back({"pairs", static_cast<int64_t>(pairing.pairs)});
  AddUnpaired("left", pairing.left, &report);
  AddUnpaired("right", pairing.right, &report);
  report.readings.push_back({"by_trigger", pairing.by_trigger});
  report.readings.push_back({"tolerance_ms", ToMs(pairing.tolerance_ns)});
  report.readings.push_back({"skew_p50_ms", ToMs(pairing.skew_p50_ns)});
  report.readings.push_back({"skew_p99_ms", ToMs(pairing.skew_p99_ns)});
  report.readings.push_back({"skew_max_ms", ToMs(pairing.skew_max_ns)});
  return report;
}

std::unique_ptr<StereoSource> MakeCameraPair(std::shared_ptr<CameraSource> left,
                                             std::shared_ptr<CameraSource> right,
                                             PairerOptions options) {
  return std::make_unique<CameraPair>(std::move(left), std::move(right), options);
}

}  // namespace vs
