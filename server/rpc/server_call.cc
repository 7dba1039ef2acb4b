#include "server/rpc/server_call.h"

#include <algorithm>
#include <chrono>
#include <exception>
#include <new>
#include <utility>

#include "engine/base/log.h"
#include "engine/base/str.h"
#include "server/rpc/dispatcher.h"

namespace vs {
namespace {

// A stream that has to end waits so long for its current message to go out.
constexpr int64_t kLastMessageNs = 500'000'000;

Status ClientGone() { return Cancelled("the client has gone or its deadline has passed"); }

// A bug of ours: the client learns where to look, the log says what happened.
Status Incident(const std::string& method, int64_t now_ns, std::string_view what) {
  const std::string id = Str(std::hex, now_ns);
  LogError("rpc", Str(method, " failed, incident ", id, ": ", what));
  return Internal(Str("internal error; the server's log tells more under incident ", id));
}

}  // namespace

// Outlives the call in the hands of whoever may wake it. Wake() must not own the call any longer
// than it takes to hand it on: the last owner runs the source's destructor.
struct ServerCall::Waker {
  explicit Waker(Dispatcher& owner) : dispatcher(owner) {}

  void Wake() {
    if (pending.exchange(true)) return;
    if (std::shared_ptr<ServerCall> target = call.lock()) {
      dispatcher.stream_.Post([target = std::move(target)] { target->OnWake(); });
    }
  }

  Dispatcher& dispatcher;  // there as long as the call is
  std::weak_ptr<ServerCall> call;
  std::atomic<bool> pending{false};
};

ServerCall::ServerCall(Dispatcher& dispatcher, const Method* method, Call call, bool recorded,
                       Channel& channel)
    : dispatcher_(dispatcher),
      method_(method),
      call_(std::move(call)),
      recorded_(recorded),
      waker_(std::make_shared<Waker>(dispatcher)),
      channel_(&channel) {
  call_.cancelled = cancelled_.get_token();
}

ServerCall::~ServerCall() { dispatcher_.Remove(this); }

void ServerCall::Begin() {
  waker_->call = weak_from_this();
  if (method_->client_streaming) {
    if (const Status added = dispatcher_.AddStream(this); !added.ok()) {
      FinishWith(added);
      return;
    }
  }
  MutexLock lock(mutex_);
  // Unless the server shuts down at this moment.
  if (phase_ == Phase::kReceiving) channel_->Receive();
}

void ServerCall::Refuse(const Status& status) { FinishWith(status); }

void ServerCall::OnRequest(std::optional<std::string> bytes) {
  {
    MutexLock lock(mutex_);
    if (phase_ != Phase::kReceiving) return;
    phase_ = Phase::kWorking;
    call_.arrived_ns = dispatcher_.clock_.MonotonicNs();
  }
  if (!bytes) {
    FinishWith(method_->client_streaming ? Status()
                                         : InvalidArgument("the call came without a request"));
    return;
  }
  const size_t limit_bytes = method_->options.max_request_bytes;
  if (bytes->size() > limit_bytes) {
    FinishWith(ResourceExhausted(Str("the request has ", bytes->size(),
                                     " bytes, this method takes ", "at most ", limit_bytes)));
    return;
  }
  if (recorded_ && method_->subject) {
    std::optional<std::string> subject = method_->subject(*bytes);
    recorded_ = subject.has_value();
    if (subject) call_.subject = *std::move(subject);
  }
  if (method_->options.admit) {
    if (const Status admitted = method_->options.admit(call_); !admitted.ok()) {
      FinishWith(admitted);
      return;
    }
  }
  if (method_->options.lane == Lane::kInline) {
    Guarded([&] { RunHandler(*bytes); });
    return;
  }
  const auto request = std::make_shared<const std::string>(std::move(*bytes));
  const Status queued = dispatcher_.Post(
      method_->options.lane, *this,
      [self = shared_from_this(), request] { self->Guarded([&] { self->RunHandler(*request); }); });
  if (!queued.ok()) FinishWith(queued);
}

void ServerCall::RunHandler(const std::string& request) {
  if (const std::optional<Status> reason = ReasonToEnd()) {
    FinishWith(*reason);
  } else if (method_->answer) {
    Answer(request);
  } else {
    OpenSource(request);
  }
}

void ServerCall::Answer(const std::string& request) {
  Result<WireMessage> answer = method_->answer(call_, request);
  if (!answer) {
    const bool stopped = answer.error().code() == StatusCode::kCancelled;
    FinishWith(stopped ? ReasonToEnd().value_or(answer.error()) : answer.error());
  } else if (method_->client_streaming) {
    SendNext(std::move(*answer));
  } else {
    MutexLock lock(mutex_);
    Close(Status(), std::move(*answer));
  }
}

void ServerCall::OpenSource(const std::string& request) {
  Result<std::unique_ptr<StreamSource>> source = method_->open(call_, request);
  if (!source) {
    FinishWith(source.error());
    return;
  }
  source_ = std::move(*source);
  if (const Status added = dispatcher_.AddStream(this); !added.ok()) {
    FinishWith(added);
    return;
  }
  source_->Start([waker = waker_] { waker->Wake(); });
  Pump();
}

void ServerCall::Pump() {
  while (true) {
    if (const std::optional<Status> reason = ReasonToEnd()) {
      FinishWith(*reason);
      return;
    }
    waker_->pending = false;
    StreamStep step = source_->Next();
    switch (step.kind) {
      case StreamStep::Kind::kMessage:
        SendNext(std::move(step.message));
        return;
      case StreamStep::Kind::kEnd:
        FinishWith(step.status);
        return;
      case StreamStep::Kind::kWait:
        if (RestUntil(step.until_ns)) return;
    }
  }
}

std::optional<Status> ServerCall::ReasonToEnd() {
  MutexLock lock(mutex_);
  if (ending_) return ending_;
  if (call_.cancelled.stop_requested()) return ClientGone();
  return std::nullopt;
}

bool ServerCall::RestUntil(std::optional<int64_t> until_ns) {
  MutexLock lock(mutex_);
  if (ending_ || call_.cancelled.stop_requested() || waker_->pending) return false;
  phase_ = Phase::kWaiting;
  if (until_ns) {
    const int64_t now_ns = dispatcher_.clock_.MonotonicNs();
    const bool earlier_is_asked = timer_ns_ > now_ns && timer_ns_ <= *until_ns;
    if (!earlier_is_asked) {
      timer_ns_ = *until_ns;
      dispatcher_.timer_.At(*until_ns, [waker = waker_] { waker->Wake(); });
    }
  }
  return true;
}

void ServerCall::OnWake() {
  {
    MutexLock lock(mutex_);
    if (phase_ != Phase::kWaiting) return;
    phase_ = Phase::kWorking;
  }
  Guarded([this] { Pump(); });
}

void ServerCall::SendNext(WireMessage message) {
  MutexLock lock(mutex_);
  if (!method_->server_streaming) {
    Close(Status(), std::move(message));
    return;
  }
  phase_ = Phase::kSending;
  sending_since_ns_ = dispatcher_.clock_.MonotonicNs();
  sending_bytes_ = SizeBytes(message);
  channel_->Send(std::move(message));
}

void ServerCall::OnSent(bool ok) {
  {
    MutexLock lock(mutex_);
    if (phase_ != Phase::kSending) return;
    phase_ = Phase::kWorking;
    sent_something_ = true;
    if (ok && !ending_ && method_->client_streaming) {
      phase_ = Phase::kReceiving;
      channel_->Receive();
      return;
    }
  }
  if (!ok) {
    FinishWith(ReasonToEnd().value_or(ClientGone()));
  } else if (const std::optional<Status> reason = ReasonToEnd()) {
    FinishWith(*reason);
  } else if (!dispatcher_.stream_.Post(
                 [self = shared_from_this()] { self->Guarded([&] { self->Pump(); }); })) {
    FinishWith(Unavailable("the server is shutting down"));
  }
}

void ServerCall::OnCancelled() {
  cancelled_.request_stop();
  FinishIfAtRest(ClientGone());
}

void ServerCall::OnDone() {
  MutexLock lock(mutex_);
  channel_ = nullptr;
}

void ServerCall::End(const Status& status) {
  {
    MutexLock lock(mutex_);
    if (!ending_) {
      ending_ = status;
      ending_since_ns_ = dispatcher_.clock_.MonotonicNs();
    }
  }
  cancelled_.request_stop();
  FinishIfAtRest(status);
}

void ServerCall::FinishIfAtRest(const Status& status) {
  {
    MutexLock lock(mutex_);
    if (phase_ != Phase::kWaiting && phase_ != Phase::kReceiving) return;
    phase_ = Phase::kWorking;
  }
  FinishWith(status);
}

void ServerCall::Recheck() {
  bool in_use = false;
  {
    MutexLock lock(mutex_);
    in_use = std::exchange(sent_something_, false);
  }
  const Status allowed = dispatcher_.gatekeeper_.Recheck(call_.method, call_.caller, in_use);
  if (!allowed.ok()) End(allowed);
}

void ServerCall::CutOffIfUnread(int64_t now_ns) {
  MutexLock lock(mutex_);
  const bool sending = phase_ == Phase::kSending || phase_ == Phase::kDone;
  if (!sending || cut_off_ || channel_ == nullptr) return;
  const std::chrono::nanoseconds unread(now_ns - sending_since_ns_);
  if (unread > dispatcher_.options_.unread.For(sending_bytes_)) {
    LogInfo("rpc",
            Str("ended ", call_.method, " of ", call_.caller.name, " at ", call_.address, ": ",
                sending_bytes_, " bytes were not read within ", unread.count() / 1'000'000, " ms"));
    if (!ending_) ending_ = Cancelled("the client did not read");
  } else if (!ending_ || now_ns - std::max(ending_since_ns_, sending_since_ns_) <= kLastMessageNs) {
    return;
  }
  cut_off_ = true;
  channel_->Abort();
}

void ServerCall::FinishWith(const Status& status) {
  std::unique_ptr<StreamSource> source;  // goes after the lock is released
  MutexLock lock(mutex_);
  if (phase_ == Phase::kDone) return;
  source = std::move(source_);
  Close(status, std::nullopt);
}

void ServerCall::Close(const Status& status, std::optional<WireMessage> last_message) {
  phase_ = Phase::kDone;
  sending_since_ns_ = dispatcher_.clock_.MonotonicNs();
  sending_bytes_ = last_message ? SizeBytes(*last_message) : 0;
  const bool streaming = method_ != nullptr && method_->server_streaming;
  dispatcher_.Finished(
      *this, status, streaming,
      call_.arrived_ns == 0 ? 0 : dispatcher_.clock_.MonotonicNs() - call_.arrived_ns);
  if (last_message) {
    channel_->SendAndFinish(std::move(*last_message));
  } else {
    channel_->Finish(status);
  }
}

template <class Function>
void ServerCall::Guarded(Function function) {
  try {
    function();
  } catch (const std::bad_alloc&) {
    FinishWith(ResourceExhausted("the server is out of memory for this call"));
  } catch (const std::exception& error) {
    FinishWith(Incident(call_.method, dispatcher_.clock_.MonotonicNs(), error.what()));
  }
}

}  // namespace vs
