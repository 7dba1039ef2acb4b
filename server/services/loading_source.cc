#include "server/services/loading_source.h"

#include <deque>
#include <optional>
#include <utility>

namespace vs {

struct LoadingSource::State {
  explicit State(Load f) : load(std::move(f)) {}

  // On the executor.
  void Run() VS_EXCLUDES(mutex) {
    Result<LoadedPage> page = load();
    {
      MutexLock lock(mutex);
      loading = false;
      if (!page) {
        ended = page.error();
      } else {
        for (WireMessage& message : page->messages) ready.push_back(std::move(message));
        if (page->then == LoadedPage::Then::kEnd) ended = Status();
        idle = page->then == LoadedPage::Then::kIdle && !news;
      }
    }
    wake();
  }

  const Load load;
  std::function<void()> wake;  // set before the first Run
  Mutex mutex;
  std::deque<WireMessage> ready VS_GUARDED_BY(mutex);
  std::optional<Status> ended VS_GUARDED_BY(mutex);
  bool loading VS_GUARDED_BY(mutex) = false;
  bool news VS_GUARDED_BY(mutex) = false;  // heard since the load began
  bool idle VS_GUARDED_BY(mutex) = false;  // nothing is there to load
};

LoadingSource::LoadingSource(Executor& executor, Load load, Listen listen)
    : executor_(executor),
      listen_(std::move(listen)),
      state_(std::make_shared<State>(std::move(load))) {}

void LoadingSource::Start(std::function<void()> wake) {
  state_->wake = std::move(wake);
  if (!listen_) return;
  listening_ = listen_([state = state_.get()] {
    {
      MutexLock lock(state->mutex);
      state->news = true;
      state->idle = false;
      if (state->loading) return;
    }
    state->wake();
  });
}

StreamStep LoadingSource::Next() {
  {
    MutexLock lock(state_->mutex);
    if (!state_->ready.empty()) {
      StreamStep step = StreamStep::Message(std::move(state_->ready.front()));
      state_->ready.pop_front();
      return step;
    }
    if (state_->ended) return StreamStep::End(*state_->ended);
    if (state_->loading || state_->idle) return StreamStep::Wait();
    state_->loading = true;
    state_->news = false;
  }
  if (executor_.Post([state = state_] { state->Run(); })) return StreamStep::Wait();
  return StreamStep::End(
      ResourceExhausted("too many clients read from the disk at once: try again later"));
}

}  // namespace vs
