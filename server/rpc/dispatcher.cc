#include "server/rpc/dispatcher.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "engine/base/str.h"

namespace vs {
namespace {

// To whom a call is charged.
const std::string& SessionOf(const Call& call) {
  return call.caller.credential_id.empty() ? call.address : call.caller.credential_id;
}

Status ShuttingDown() { return Unavailable("the server is shutting down"); }

}  // namespace

Dispatcher::Dispatcher(const Router& router, Gatekeeper& gatekeeper,
                       const DispatcherOptions& options, Auditor* auditor)
    : router_(router),
      gatekeeper_(gatekeeper),
      auditor_(auditor),
      options_(options),
      quick_(options.quick_threads, options.quick_queue),
      slow_(options.slow_threads, options.slow_queue),
      list_(1, options.list_queue),
      query_(options.queries),
      password_(1, options.password_queue),
      // Each open stream queues at most twice, and their number is bounded.
      stream_(options.stream_threads, std::numeric_limits<size_t>::max()) {
  for (const auto& [name, method] : router.methods()) counters_[name];
  timer_.At(0, [this] { Inspect(); });
}

Dispatcher::~Dispatcher() {
  // Their tasks may still post to each other, so all of them stop before any of them goes.
  query_.Stop();
  for (Executor* executor : {&quick_, &slow_, &list_, &password_, &stream_}) executor->Stop();
}

std::shared_ptr<ServerCall> Dispatcher::Begin(const std::string& method,
                                              std::string_view credential, std::string address,
                                              Channel& channel) {
  const Method* found = router_.Find(method);
  const Result<Caller> caller = gatekeeper_.Admit(method, credential);
  Call call{.method = method, .address = std::move(address)};
  const bool recorded = found != nullptr && Records(method);
  if (caller) {
    call.caller = *caller;
  } else if (recorded) {
    call.caller = gatekeeper_.Identify(credential);
  }
  auto server_call = std::make_shared<ServerCall>(*this, found, std::move(call), recorded, channel);
  Add(server_call);
  if (!caller) {
    server_call->Refuse(caller.error());
  } else if (found == nullptr) {
    server_call->Refuse(Unimplemented(Str("there is no method ", method)));
  } else if (draining_) {
    server_call->Refuse(ShuttingDown());
  } else {
    server_call->Begin();
  }
  return server_call;
}

void Dispatcher::Drain() {
  draining_ = true;
  for (const auto& call : Calls()) call->End(ShuttingDown());
}

bool Dispatcher::Idle() const {
  MutexLock lock(mutex_);
  return calls_.empty();
}

size_t Dispatcher::OpenStreams() const {
  MutexLock lock(mutex_);
  return streams_.size();
}

std::vector<MethodStats> Dispatcher::Statistics() const {
  std::vector<MethodStats> all;
  for (const auto& [name, counters] : counters_) {
    MethodStats stats{.method = name, .succeeded = counters.succeeded, .failed = counters.failed};
    if (stats.succeeded + stats.failed == 0) continue;
    if (const uint64_t timed = counters.timed; timed > 0) {
      stats.mean_us = static_cast<double>(counters.total_ns) / static_cast<double>(timed) * 1e-3;
      stats.max_us = static_cast<double>(counters.max_ns) * 1e-3;
    }
    all.push_back(std::move(stats));
  }
  return all;
}

Status Dispatcher::Post(Lane lane, const ServerCall& call, std::function<void()> task) {
  const auto post = [&task](Executor& executor) {
    if (executor.Post(std::move(task))) return Status();
    return ResourceExhausted("the server is busy with other calls of this kind; try again shortly")
        .WithReason("OVERLOADED");
  };
  switch (lane) {
    case Lane::kSlow:
      return post(slow_);
    case Lane::kList:
      return post(list_);
    case Lane::kQuery:
      return query_.Post(SessionOf(call.call()), std::move(task));
    case Lane::kPassword:
      return post(password_);
    case Lane::kInline:
    case Lane::kQuick:
      break;
  }
  return post(quick_);
}

void Dispatcher::Add(const std::shared_ptr<ServerCall>& call) {
  MutexLock lock(mutex_);
  calls_.emplace(call.get(), call);
}

void Dispatcher::Remove(const ServerCall* call) {
  MutexLock lock(mutex_);
  streams_.erase(call);
  calls_.erase(call);
}

Status Dispatcher::AddStream(const ServerCall* call) {
  MutexLock lock(mutex_);
  if (streams_.size() >= options_.max_open_streams) {
    return ResourceExhausted(Str("all clients together have ", options_.max_open_streams,
                                 " streams open, the server's limit; close some"));
  }
  const std::string& session = SessionOf(call->call());
  const auto own = std::count_if(streams_.begin(), streams_.end(), [&](const ServerCall* stream) {
    return SessionOf(stream->call()) == session;
  });
  if (static_cast<size_t>(own) >= options_.max_streams_per_session) {
    return ResourceExhausted(Str("this login has ", own, " streams open, its limit; close some"));
  }
  streams_.insert(call);
  return Status();
}

void Dispatcher::Finished(const ServerCall& call, const Status& status, bool streaming,
                          int64_t took_ns) {
  {
    MutexLock lock(mutex_);
    streams_.erase(&call);
  }
  if (call.recorded()) auditor_->Record(call.call(), status);
  const auto found = counters_.find(call.call().method);
  if (found == counters_.end()) return;
  Counters& counters = found->second;
  // Whoever has seen enough of a stream just leaves.
  const bool left = streaming && status.code() == StatusCode::kCancelled;
  ++(status.ok() || left ? counters.succeeded : counters.failed);
  if (streaming || took_ns == 0) return;
  ++counters.timed;
  counters.total_ns += took_ns;
  int64_t max_ns = counters.max_ns;
  while (max_ns < took_ns && !counters.max_ns.compare_exchange_weak(max_ns, took_ns)) {
  }
}

std::vector<std::shared_ptr<ServerCall>> Dispatcher::Calls() const {
  std::vector<std::shared_ptr<ServerCall>> all;
  MutexLock lock(mutex_);
  for (const auto& [key, weak] : calls_) {
    if (auto call = weak.lock()) all.push_back(std::move(call));
  }
  return all;
}

std::vector<std::shared_ptr<ServerCall>> Dispatcher::Streams() const {
  std::vector<std::shared_ptr<ServerCall>> all;
  MutexLock lock(mutex_);
  for (const ServerCall* stream : streams_) {
    if (auto call = calls_.at(stream).lock()) all.push_back(std::move(call));
  }
  return all;
}

void Dispatcher::Inspect() {
  const int64_t now_ns = clock_.MonotonicNs();
  for (const auto& stream : Streams()) stream->Recheck();
  for (const auto& call : Calls()) {
    call->CutOffIfUnread(now_ns);
    // What began while the drain did.
    if (draining_) call->End(ShuttingDown());
  }
  timer_.At(now_ns + options_.inspection_period_ns, [this] { Inspect(); });
}

}  // namespace vs
