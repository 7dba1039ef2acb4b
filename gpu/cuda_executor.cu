// All stages on a device, in a stream of its own, so that executors do not wait for each other. The
// stages of a configuration are recorded once and launched as a whole.
#include <cuda_runtime.h>

#include <algorithm>
#include <cstring>
#include <utility>

#include "engine/base/str.h"
#include "gpu/cuda_device.h"
#include "gpu/cuda_executor.h"
#include "gpu/devices.h"
#include "gpu/download.h"
#include "gpu/frame.h"
#include "gpu/stages.h"

#define VS_CUDA(call) VS_RETURN_IF_ERROR(device_.Check(call, #call))

namespace vs::gpu {
namespace {

constexpr int kPoison = 0xa5;

VS_KERNEL Probe() {}
VS_KERNEL WriteTo(int* nowhere) { *nowhere = 1; }

// Records or starts kernels in a stream. Remembers the first error.
class CudaLaunch {
 public:
  explicit CudaLaunch(cudaStream_t stream) : stream_(stream) {}

  template <class... Params, class... Args>
  void operator()(void (*kernel)(Params...), Grid grid, int threads_in_block, Args&&... args) {
    if (error_ != cudaSuccess) return;
    cudaLaunchConfig_t config{};
    config.gridDim = dim3(static_cast<unsigned>(grid.x), static_cast<unsigned>(grid.y));
    config.blockDim = dim3(static_cast<unsigned>(threads_in_block));
    config.stream = stream_;
    error_ = cudaLaunchKernelEx(&config, kernel, static_cast<Params>(args)...);
  }

  cudaError_t error() const { return error_; }

 private:
  cudaStream_t stream_;
  cudaError_t error_ = cudaSuccess;
};

class CudaExecutor final : public Executor {
 public:
  CudaExecutor(CudaDevice& device, uint64_t generation, const CudaExecutorOptions& options)
      : device_(device),
        generation_(generation),
        options_(options),
        host_memory_(MakePinner(device, generation)) {}
  ~CudaExecutor() override;

  Status Open();
  Status Prepare(const StereoPlan& plan, int width, int height) override;
  Result<StereoResult> Run(const GreyImage& left, const GreyImage& right,
                           BufferPool& pool) override;
  size_t DeviceBytes() const override { return bytes_; }
  int64_t StagesNs() const override { return stages_ns_; }

 private:
  Status MakeRoom(const StereoPlan& plan, int width, int height);
  void ForgetStages();
  void GiveBack();
  Status Record();
  void Stage(const GreyImage& picture, int view);
  size_t UploadBytes() const;

  CudaDevice& device_;
  const uint64_t generation_;
  const CudaExecutorOptions options_;
  BufferPool host_memory_;
  Buffer staging_;  // both pictures as they lie on the device

  cudaStream_t stream_ = nullptr;
  cudaEvent_t begin_ = nullptr;
  cudaEvent_t end_ = nullptr;
  std::byte* memory_ = nullptr;
  size_t bytes_ = 0;  // of `memory_`
  cudaGraphExec_t stages_ = nullptr;
  bool prepared_ = false;
  StereoPlan plan_;
  size_t kept_bytes_ = 0;
  Frame frame_;
  DeviceMap map_{};
  int64_t stages_ns_ = 0;
  int frames_ = 0;
};

CudaExecutor::~CudaExecutor() {
  const auto use = device_.Enter(generation_);
  if (!use.has_value()) return;  // it is gone already, or goes with the reset
  GiveBack();
  for (const cudaEvent_t event : {begin_, end_}) {
    if (event != nullptr) (void)device_.Check(cudaEventDestroy(event), "cudaEventDestroy");
  }
  if (stream_ != nullptr) (void)device_.Check(cudaStreamDestroy(stream_), "cudaStreamDestroy");
}

Status CudaExecutor::Open() {
  VS_ASSIGN_OR_RETURN(const auto use, device_.Enter(generation_));
  cudaFuncAttributes attributes{};
  const cudaError_t probed = cudaFuncGetAttributes(&attributes, Probe);
  if (probed == cudaErrorNoKernelImageForDevice || probed == cudaErrorInvalidDeviceFunction) {
    return FailedPrecondition(Str("this program is not built for GPU ", device_.index(),
                                  " of compute capability ",
                                  (*Devices())[static_cast<size_t>(device_.index())].compute));
  }
  VS_RETURN_IF_ERROR(device_.Check(probed, "cudaFuncGetAttributes"));
  VS_CUDA(cudaStreamCreateWithFlags(&stream_, cudaStreamNonBlocking));
  VS_CUDA(cudaEventCreate(&begin_));
  VS_CUDA(cudaEventCreate(&end_));
  return {};
}

Status CudaExecutor::Prepare(const StereoPlan& plan, int width, int height) {
  if (prepared_ && plan_ == plan && frame_.raw_width == width && frame_.raw_height == height) {
    return {};
  }
  prepared_ = false;
  // Before the device is entered: pools enter it themselves.
  staging_ = {};
  staging_ = host_memory_.Acquire(2 * (static_cast<size_t>(width) * height + 256));
  kept_bytes_ = FrameMemory(plan, width, height, nullptr).KeptBytes();
  const Buffer kept = host_memory_.Acquire(kept_bytes_);
  FillKept(plan, FrameMemory(plan, width, height, kept.data).frame());
  VS_ASSIGN_OR_RETURN(const auto use, device_.Enter(generation_));
  VS_RETURN_IF_ERROR(MakeRoom(plan, width, height));
  VS_CUDA(cudaMemcpyAsync(memory_, kept.data, kept_bytes_, cudaMemcpyHostToDevice, stream_));
  VS_CUDA(cudaStreamSynchronize(stream_));  // `kept` goes
  VS_RETURN_IF_ERROR(Record());
  plan_ = plan;
  prepared_ = true;
  return {};
}

Status CudaExecutor::MakeRoom(const StereoPlan& plan, int width, int height) {
  const size_t needed = FrameMemory(plan, width, height, nullptr).Bytes();
  ForgetStages();
  // A parameter that is changed while others work asks for no memory: that stops the whole device.
  if (needed <= bytes_ && needed >= bytes_ / 2) {
    frame_ = FrameMemory(plan, width, height, memory_).frame();
    return {};
  }
  GiveBack();
  void* memory = nullptr;
  const cudaError_t got = cudaMalloc(&memory, needed);
  if (got == cudaErrorMemoryAllocation) {
    (void)cudaGetLastError();
    size_t free = 0;
    size_t total = 0;
    VS_CUDA(cudaMemGetInfo(&free, &total));
    return ResourceExhausted(Str("GPU ", device_.index(), ": pictures of ", width, " x ", height,
                                 " px with ", plan.settings.num_disparities, " disparities need ",
                                 needed, " bytes of its memory, ", free,
                                 " are available; search a smaller range, match smaller pictures, "
                                 "or choose another backend"));
  }
  VS_RETURN_IF_ERROR(device_.Check(got, "cudaMalloc"));
  memory_ = static_cast<std::byte*>(memory);
  bytes_ = needed;
  frame_ = FrameMemory(plan, width, height, memory_).frame();
  return {};
}

void CudaExecutor::ForgetStages() {
  if (stages_ != nullptr) {
    (void)device_.Check(cudaGraphExecDestroy(stages_), "cudaGraphExecDestroy");
  }
  stages_ = nullptr;
}

void CudaExecutor::GiveBack() {
  ForgetStages();
  if (memory_ != nullptr) (void)device_.Check(cudaFree(memory_), "cudaFree");
  memory_ = nullptr;
  bytes_ = 0;
}

Status CudaExecutor::Record() {
  // Relaxed: kernels are loaded as they are recorded.
  VS_CUDA(cudaStreamBeginCapture(stream_, cudaStreamCaptureModeRelaxed));
  CudaLaunch launch(stream_);
  const cudaError_t cleared = cudaMemsetAsync(frame_.counts, 0, sizeof *frame_.counts, stream_);
  map_ = RunStages(launch, frame_);
  cudaGraph_t graph = nullptr;
  const cudaError_t recorded = cudaStreamEndCapture(stream_, &graph);
  Status status = device_.Check(launch.error(), "cudaLaunchKernelEx");
  if (status.ok()) status = device_.Check(cleared, "cudaMemsetAsync");
  if (status.ok()) status = device_.Check(recorded, "cudaStreamEndCapture");
  if (status.ok()) {
    status = device_.Check(cudaGraphInstantiate(&stages_, graph, 0), "cudaGraphInstantiate");
  }
  if (graph != nullptr) (void)device_.Check(cudaGraphDestroy(graph), "cudaGraphDestroy");
  VS_RETURN_IF_ERROR(status);
  VS_CUDA(cudaGraphUpload(stages_, stream_));
  return {};
}

size_t CudaExecutor::UploadBytes() const {
  return static_cast<size_t>(frame_.uploaded[kRight] - frame_.uploaded[kLeft]) +
         static_cast<size_t>(frame_.raw_width) * frame_.raw_height;
}

void CudaExecutor::Stage(const GreyImage& picture, int view) {
  std::byte* to = staging_.data + (frame_.uploaded[view] - frame_.uploaded[kLeft]);
  const auto width = static_cast<size_t>(picture.width());
  if (picture.stride_bytes() == width) {
    std::memcpy(to, picture.Row(0), width * static_cast<size_t>(picture.height()));
    return;
  }
  for (int y = 0; y < picture.height(); ++y, to += width) std::memcpy(to, picture.Row(y), width);
}

Result<StereoResult> CudaExecutor::Run(const GreyImage& left, const GreyImage& right,
                                       BufferPool& /*pool*/) {
  const Download download = DownloadOf(frame_, map_);
  const Buffer result = host_memory_.Acquire(download.size_bytes);
  VS_ASSIGN_OR_RETURN(const auto use, device_.Enter(generation_));
  if (options_.poison) {
    std::memset(result.data, kPoison, result.size_bytes);
    VS_CUDA(cudaMemsetAsync(memory_ + kept_bytes_, kPoison, bytes_ - kept_bytes_, stream_));
  }
  if (++frames_ == options_.spoil_frame) {
    CudaLaunch launch(stream_);
    launch(&WriteTo, Grid{}, kWarpSize, nullptr);
  }
  Stage(left, kLeft);
  Stage(right, kRight);
  VS_CUDA(cudaMemcpyAsync(frame_.uploaded[kLeft], staging_.data, UploadBytes(),
                          cudaMemcpyHostToDevice, stream_));
  VS_CUDA(cudaEventRecord(begin_, stream_));
  VS_CUDA(cudaGraphLaunch(stages_, stream_));
  VS_CUDA(cudaEventRecord(end_, stream_));
  VS_CUDA(cudaMemcpyAsync(result.data, download.begin, download.size_bytes, cudaMemcpyDeviceToHost,
                          stream_));
  VS_CUDA(cudaStreamSynchronize(stream_));
  float ms = 0;
  VS_CUDA(cudaEventElapsedTime(&ms, begin_, end_));
  stages_ns_ = static_cast<int64_t>(ms * 1e6F);
  return ResultIn(result, plan_, frame_, map_, left);
}

}  // namespace

Result<std::unique_ptr<Executor>> MakeCudaExecutor(int device, const CudaExecutorOptions& options) {
  if (!Devices().has_value()) return Devices().error();
  if (device < 0 || static_cast<size_t>(device) >= Devices()->size()) {
    return NotFound(Str("there is no GPU ", device, "; this machine has ", Devices()->size()));
  }
  CudaDevice& cuda = CudaDevice::Of(device);
  VS_ASSIGN_OR_RETURN(const uint64_t generation, cuda.Revive());
  auto executor = std::make_unique<CudaExecutor>(cuda, generation, options);
  VS_RETURN_IF_ERROR(executor->Open());
  return Result<std::unique_ptr<Executor>>(std::move(executor));
}

}  // namespace vs::gpu
