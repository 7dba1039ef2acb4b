#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <utility>

#include "engine/base/mailbox.h"
#include "engine/base/mutex.h"
#include "engine/base/source_report.h"
#include "engine/base/status.h"

namespace vs {

// The way of pictures from a source, which has a thread of its own, into a block: of a live source
// the newest waits to be taken, of a recorded one each. `Source` is CameraSource or StereoSource,
// `Taken` what it delivers.
template <class Source, class Taken>
class Intake {
 public:
  // `available` is called on the source's thread whenever there is something to take.
  explicit Intake(std::function<void()> available) { box_.OnAvailable(std::move(available)); }

  Status Start(std::shared_ptr<Source> source) VS_EXCLUDES(mutex_) {
    box_.Reopen(source->Recorded() ? Box::Policy::kEvery : Box::Policy::kLatest);
    VS_RETURN_IF_ERROR(source->Start([this](Taken taken) { box_.Put(std::move(taken)); }));
    MutexLock lock(mutex_);
    source_ = std::move(source);
    return {};
  }

  void Stop() VS_EXCLUDES(mutex_) {
    box_.Close();
    std::shared_ptr<Source> ended;
    {
      MutexLock lock(mutex_);
      ended = std::exchange(source_, nullptr);
    }
    if (ended != nullptr) ended->Stop();
  }

  bool Available() const { return box_.Available(); }
  std::optional<Taken> TryTake() { return box_.TryTake(); }
  // Pictures that newer ones replaced.
  uint64_t Dropped() const { return box_.Dropped(); }
  // On any thread; empty while stopped.
  SourceReport Report() const VS_EXCLUDES(mutex_) {
    MutexLock lock(mutex_);
    return source_ == nullptr ? SourceReport() : ReportOf(source_->Stats());
  }

 private:
  using Box = Mailbox<Taken>;

  Box box_;
  mutable Mutex mutex_;
  std::shared_ptr<Source> source_ VS_GUARDED_BY(mutex_);
};

}  // namespace vs
