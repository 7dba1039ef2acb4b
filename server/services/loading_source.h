#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "engine/base/mutex.h"
#include "engine/base/status.h"
#include "server/rpc/executor.h"
#include "server/rpc/stream_source.h"

namespace vs {

// The next messages of a stream, perhaps none.
struct LoadedPage {
  enum class Then {
    kMore,  // load the next page when these have gone out
    kIdle,  // there is nothing more at the moment; load again when somebody calls
    kEnd,
  };

  std::vector<WireMessage> messages;
  Then then = Then::kMore;
};

// A stream whose messages are read from a disk, page by page, on a thread that may wait; the
// threads that serve all streams never do. The next page is read when the client has taken the one
// before.
class LoadingSource final : public StreamSource {
 public:
  // Called again and again, one call at a time.
  using Load = std::function<Result<LoadedPage>()>;
  // As PeriodicSource::Listen; may be null.
  using Listen = std::function<std::shared_ptr<void>(std::function<void()>)>;

  // `executor` must outlive the use of the source. `load` must not refer to the source.
  LoadingSource(Executor& executor, Load load, Listen listen = nullptr);

  void Start(std::function<void()> wake) override;
  StreamStep Next() override;

 private:
  struct State;

  Executor& executor_;
  const Listen listen_;
  const std::shared_ptr<State> state_;  // outlives a load that is under way
  std::shared_ptr<void> listening_;
};

}  // namespace vs
