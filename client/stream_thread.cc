#include "client/stream_thread.h"

#include <algorithm>
#include <chrono>
#include <utility>

namespace vs::client {
namespace {

using std::chrono::milliseconds;

constexpr milliseconds kFirstPause{200};
constexpr milliseconds kLongestPause{5000};

// Whether the same request may succeed later, without anybody doing anything about it.
bool MayRecover(grpc::StatusCode code) {
  switch (code) {
    case grpc::OK:  // the server ended the stream, which it does when it stops
    case grpc::UNAVAILABLE:
    case grpc::CANCELLED:
    case grpc::ABORTED:
    case grpc::INTERNAL:
    case grpc::UNKNOWN:
    case grpc::RESOURCE_EXHAUSTED:
    case grpc::DEADLINE_EXCEEDED:
      return true;
    default:
      return false;
  }
}

}  // namespace

StreamThread::StreamThread(std::shared_ptr<Connection> connection, Hooks hooks)
    : connection_(std::move(connection)),
      hooks_(std::move(hooks)),
      jitter_(std::random_device()()),
      thread_([this] { Run(); }) {}

StreamThread::~StreamThread() {
  {
    const std::lock_guard lock(mutex_);
    stop_ = true;
    if (open_ != nullptr) open_->TryCancel();
  }
  stopped_.notify_all();
  thread_.join();
}

void StreamThread::Run() {
  for (;;) {
    grpc::ClientContext context;
    connection_->Prepare(context, std::nullopt);
    {
      const std::lock_guard lock(mutex_);
      if (stop_) return;
      open_ = &context;
    }
    const grpc::Status status = hooks_.read(context);
    {
      const std::lock_guard lock(mutex_);
      open_ = nullptr;
      if (stop_) return;
    }
    const bool final = !MayRecover(status.error_code());
    hooks_.ended(
        status.ok() ? ToError({grpc::UNAVAILABLE, "the server ended the stream"}) : ToError(status),
        final);
    if (final || !Pause()) return;
  }
}

bool StreamThread::Pause() {
  const milliseconds longest = std::min(kLongestPause, kFirstPause * (1 << std::min(attempts_, 8)));
  ++attempts_;
  const milliseconds pause(std::uniform_int_distribution<milliseconds::rep>(
      longest.count() / 2, longest.count())(jitter_));
  std::unique_lock lock(mutex_);
  return !stopped_.wait_for(lock, pause, [this] { return stop_; });
}

}  // namespace vs::client
