#include "gpu/cuda_matcher.h"

#include <optional>
#include <utility>
#include <vector>

#include "engine/base/log.h"
#include "engine/base/str.h"

namespace vs::gpu {
namespace {

class CudaMatcher final : public StereoMatcher {
 public:
  CudaMatcher(const CudaMatcherOptions& options, DeviceBoard::Seat seat)
      : options_(options), seat_(std::move(seat)) {}

  Status Start() {
    Status made = MakeExecutor();
    if (made.ok() || made.code() == StatusCode::kResourceExhausted ||
        made.code() == StatusCode::kFailedPrecondition) {
      return made;
    }
    DoWithout(made);
    return MakeSubstitute();
  }
  int device() const { return seat_.device(); }

  // Of any other error the first frame takes care.
  Status Reserve(const StereoPlan& plan, int width, int height) override {
    const RectifiedGeometry geometry = GeometryOf(plan, width, height);
    const bool matched_here =
        !plan.region.has_value() && ValidateSize(geometry.width, geometry.height).ok();
    if (executor_ == nullptr || !matched_here) return {};
    Status reserved = executor_->Prepare(plan, width, height);
    return reserved.code() == StatusCode::kResourceExhausted ? reserved : Status();
  }

  // On the device; of the substitute's, while that works.
  size_t WorkingBytes() const override {
    if (executor_ != nullptr) return executor_->DeviceBytes();
    return substitute_ != nullptr ? substitute_->WorkingBytes() : 0;
  }

 private:
  Result<DisparityMap> MatchPair(const GreyImage& left, const GreyImage& right,
                                 const SgmSettings& settings, int threads,
                                 BufferPool& pool) override {
    VS_ASSIGN_OR_RETURN(StereoResult result,
                        ProcessPair(left, right, {.settings = settings}, threads, pool));
    return std::move(result.disparity);
  }

  Result<StereoResult> ProcessPair(const GreyImage& left, const GreyImage& right,
                                   const StereoPlan& plan, int threads, BufferPool& pool) override {
    if (executor_ != nullptr || NowNs() - failed_ns_ >= kForgetNs) {
      Result<StereoResult> result = RunOnDevice(left, right, plan, pool);
      if (result.has_value()) {
        seat_.Works();
        substitute_.reset();
        return result;
      }
      const bool refused = result.error().code() == StatusCode::kResourceExhausted;
      if (refused && executor_ != nullptr && substitute_ == nullptr) return result;
      DoWithout(result.error());
    }
    VS_RETURN_IF_ERROR(MakeSubstitute());
    return substitute_->Process(left, right, plan, threads, pool);
  }

  Result<StereoResult> RunOnDevice(const GreyImage& left, const GreyImage& right,
                                   const StereoPlan& plan, BufferPool& pool) {
    if (executor_ == nullptr) {
      VS_RETURN_IF_ERROR(MakeExecutor());
      return RunOnce(left, right, plan, pool);
    }
    Result<StereoResult> result = RunOnce(left, right, plan, pool);
    if (result.has_value()) return result;
    if (result.error().code() == StatusCode::kResourceExhausted) return result;
    const int64_t now_ns = NowNs();
    const bool again = failed_ns_ != 0 && now_ns - failed_ns_ < kForgetNs;
    failed_ns_ = now_ns;
    if (again) return result;
    LogWarn("gpu", Str("is started anew after: ", result.error().message()));
    VS_RETURN_IF_ERROR(MakeExecutor());
    return RunOnce(left, right, plan, pool);
  }

  Result<StereoResult> RunOnce(const GreyImage& left, const GreyImage& right,
                               const StereoPlan& plan, BufferPool& pool) {
    VS_RETURN_IF_ERROR(executor_->Prepare(plan, left.width(), left.height()));
    return executor_->Run(left, right, pool);
  }

  Status MakeExecutor() {
    executor_.reset();  // its memory is needed
    VS_ASSIGN_OR_RETURN(executor_, options_.make_executor(seat_.device()));
    return {};
  }

  void DoWithout(const Status& why) {
    executor_.reset();
    failed_ns_ = NowNs();
    seat_.Fails(why);
  }

  Status MakeSubstitute() {
    if (substitute_ != nullptr) return {};
    VS_ASSIGN_OR_RETURN(substitute_, options_.make_substitute());
    return {};
  }

  int64_t NowNs() const { return options_.clock->MonotonicNs(); }

  const CudaMatcherOptions options_;
  DeviceBoard::Seat seat_;
  std::unique_ptr<Executor> executor_;         // null while the device does not work
  std::unique_ptr<StereoMatcher> substitute_;  // null while it does
  int64_t failed_ns_ = 0;                      // when it did so last; 0: never
};

}  // namespace

Result<std::unique_ptr<StereoMatcher>> MakeCudaMatcher(const CudaMatcherOptions& options,
                                                       int device) {
  std::vector<int> refused;  // devices
  Status why;
  while (true) {
    Result<DeviceBoard::Seat> seat = options.board->Take(device, refused);
    if (!seat.has_value()) return refused.empty() ? seat.error() : why;
    auto matcher = std::make_unique<CudaMatcher>(options, *std::move(seat));
    why = matcher->Start();
    if (why.ok()) return Result<std::unique_ptr<StereoMatcher>>(std::move(matcher));
    if (device != DeviceBoard::kAny) return why;
    refused.push_back(matcher->device());
  }
}

}  // namespace vs::gpu
