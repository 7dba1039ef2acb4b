#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "engine/base/clock.h"
#include "engine/base/mutex.h"
#include "server/rpc/auditor.h"
#include "server/rpc/executor.h"
#include "server/rpc/fair_executor.h"
#include "server/rpc/gatekeeper.h"
#include "server/rpc/patience.h"
#include "server/rpc/router.h"
#include "server/rpc/server_call.h"
#include "server/rpc/timer.h"

namespace vs {

struct DispatcherOptions {
  int quick_threads = 4;
  size_t quick_queue = 256;
  int slow_threads = 4;
  size_t slow_queue = 64;
  size_t list_queue = 64;
  FairExecutorOptions queries{.threads = kQueriesAtOnce};
  // Each hash takes 64 MiB and a fifth of a second: one at a time, and few may wait.
  size_t password_queue = 16;
  int stream_threads = 2;
  size_t max_open_streams = 1024;
  // Of one login session or API key; of one address when nobody is logged in.
  size_t max_streams_per_session = 32;
  // A client that does not read a whole message or answer in the time for its size loses its call.
  // What is read of it meanwhile only the network knows.
  Patience unread;
  // How often calls are inspected; revocation ends open streams within twice that.
  int64_t inspection_period_ns = 250'000'000;
};

// What was called how often, since start.
struct MethodStats {
  std::string method;
  uint64_t succeeded = 0;
  uint64_t failed = 0;
  double mean_us = 0;  // of unary calls, from the request to the answer
  double max_us = 0;
};

// Takes calls from whatever network, lets them pass the gate, and runs them. Thread-safe.
class Dispatcher {
 public:
  // All must outlive it; the router is complete. Without an auditor nothing is recorded.
  Dispatcher(const Router& router, Gatekeeper& gatekeeper, const DispatcherOptions& options = {},
             Auditor* auditor = nullptr);
  ~Dispatcher();
  Dispatcher(const Dispatcher&) = delete;
  Dispatcher& operator=(const Dispatcher&) = delete;

  // A call has arrived. `channel` is used until its Finish. `credential`: what follows "Bearer " in
  // the metadata `authorization`, empty when there is none; `address`: of the client, no port.
  std::shared_ptr<ServerCall> Begin(const std::string& method, std::string_view credential,
                                    std::string address, Channel& channel);

  // From now on new calls get UNAVAILABLE, and so do those that no thread has begun with; open
  // streams end with it after the message under way. What is being worked on is told to stop.
  void Drain();
  // The network has let go of every call.
  bool Idle() const;
  size_t OpenStreams() const;
  // Of the methods that were called, in the order of their names.
  std::vector<MethodStats> Statistics() const;

 private:
  friend class ServerCall;
  struct Counters {
    std::atomic<uint64_t> succeeded{0};
    std::atomic<uint64_t> failed{0};
    std::atomic<uint64_t> timed{0};
    std::atomic<int64_t> total_ns{0};
    std::atomic<int64_t> max_ns{0};
  };

  // Runs `task` of `call` on its lane. RESOURCE_EXHAUSTED, UNAVAILABLE: see FairExecutor.
  Status Post(Lane lane, const ServerCall& call, std::function<void()> task);
  bool Records(const std::string& method) const {
    return auditor_ != nullptr && auditor_->Records(method);
  }
  void Add(const std::shared_ptr<ServerCall>& call) VS_EXCLUDES(mutex_);
  void Remove(const ServerCall* call) VS_EXCLUDES(mutex_);
  // RESOURCE_EXHAUSTED.
  Status AddStream(const ServerCall* call) VS_EXCLUDES(mutex_);
  // Of each call once, when its outcome is known.
  void Finished(const ServerCall& call, const Status& status, bool streaming, int64_t took_ns);
  void Inspect();
  std::vector<std::shared_ptr<ServerCall>> Calls() const VS_EXCLUDES(mutex_);
  std::vector<std::shared_ptr<ServerCall>> Streams() const VS_EXCLUDES(mutex_);

  const Router& router_;
  Gatekeeper& gatekeeper_;
  Auditor* const auditor_;
  const SystemClock clock_;
  const DispatcherOptions options_;
  std::map<std::string, Counters> counters_;  // by method; the keys never change
  std::atomic<bool> draining_{false};
  mutable Mutex mutex_;
  std::map<const ServerCall*, std::weak_ptr<ServerCall>> calls_ VS_GUARDED_BY(mutex_);
  std::set<const ServerCall*> streams_ VS_GUARDED_BY(mutex_);  // those of the calls that are open

  Executor quick_;
  Executor slow_;
  Executor list_;
  FairExecutor query_;
  Executor password_;
  Executor stream_;
  Timer timer_;  // last: it goes first and posts to the others
};

}  // namespace vs
