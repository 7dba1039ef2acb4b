#pragma once

#include <cstddef>
#include <deque>
#include <functional>
#include <memory>
#include <string>

#include "engine/base/mutex.h"
#include "server/rpc/stream_source.h"
#include "server/sequences/sequence_manager.h"

namespace vs {

// The stream of WatchParameters: all values first, then each change. A client that falls too far
// behind gets all values again instead of the changes that it missed.
class ParameterSource final : public StreamSource {
 public:
  static constexpr size_t kMaxWaiting = 64;

  // `manager` must outlive it.
  ParameterSource(SequenceManager& manager, std::string sequence);

  void Start(std::function<void()> wake) override;
  StreamStep Next() override;

 private:
  // Shared with the listener.
  struct State {
    Mutex mutex;
    std::deque<ParameterEvent> waiting VS_GUARDED_BY(mutex);
    bool tell_all VS_GUARDED_BY(mutex) = true;
  };

  StreamStep TellAll();

  SequenceManager& manager_;
  const std::string sequence_;
  const std::unique_ptr<State> state_ = std::make_unique<State>();
  std::shared_ptr<void> listening_;  // goes before what it writes to
};

}  // namespace vs
