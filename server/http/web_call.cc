#include "server/http/web_call.h"

#include <utility>

#include "engine/base/str.h"
#include "server/http/grpc_web.h"

namespace vs {
namespace {

// For a call without a deadline.
constexpr std::chrono::hours kNoDeadline{24 * 365};

// An unwanted request up to this size is read, so that its connection can be used on.
constexpr uint64_t kSkippedBytes = 64 << 10;

std::string_view CredentialOf(const HttpRequest& request) {
  static constexpr std::string_view kScheme = "Bearer ";
  const std::string_view value = request.Header("authorization");
  return value.starts_with(kScheme) ? value.substr(kScheme.size()) : std::string_view();
}

std::string ChunkHead(size_t size_bytes) { return Str(std::hex, size_bytes, "\r\n"); }

// A part of what many clients share.
class Share {
 public:
  Share(std::atomic<size_t>& total, size_t part) : total_(total), part_(part) { total_ += part_; }
  ~Share() { total_ -= part_; }
  Share(const Share&) = delete;
  Share& operator=(const Share&) = delete;

 private:
  std::atomic<size_t>& total_;
  const size_t part_;
};

}  // namespace

WebCall::WebCall(ClientStream& stream, RequestReader& reader, const HttpRequest& request,
                 const WebCallLimits& limits, std::atomic<size_t>& memory_in_use)
    : stream_(stream),
      reader_(reader),
      request_(request),
      limits_(limits),
      memory_in_use_(memory_in_use),
      request_is_read_(request.content_bytes == 0) {}

bool WebCall::Run(Dispatcher& dispatcher, const std::string& client_address) {
  const auto timeout = ParseTimeout(request_.Header("grpc-timeout"));
  if (!timeout) return Write(std::nullopt, timeout.error()) && SkipRequest();
  const Deadline deadline(clock_, timeout->value_or(kNoDeadline));
  const std::string method = request_.target.substr(0, request_.target.find('?'));
  call_ = dispatcher.Begin(method, CredentialOf(request_), client_address, *this);
  while (true) {
    if (!answered_ && deadline.Passed()) {
      GiveUp(DeadlineExceeded("the time that the client gave this call is over"));
    }
    const Step step = TakeStep();
    if (step.Nothing()) {
      WaitForStep(deadline);
      continue;
    }
    Do(step);
    if (step.finish) break;
  }
  call_->OnDone();
  return SkipRequest();
}

void WebCall::Do(const Step& step) {
  if (answered_) {
    if (step.receive) call_->OnRequest(std::nullopt);
    if (step.send && !step.finish) call_->OnSent(false);
  } else if (step.finish) {
    Write(step.send, step.finish);
  } else if (step.receive) {
    HandOverRequest();
  } else {
    call_->OnSent(Write(step.send, std::nullopt));
  }
}

void WebCall::WaitForStep(const Deadline& deadline) {
  if (answered_) {
    // What works on the call has not noticed yet that nobody waits. The client's next call must not
    // wait for that.
    usable_ = false;
    if (std::exchange(closed_, true)) {
      stream_.WaitForWake();
    } else {
      stream_.CloseGently();  // may take a wake: look for a step again before waiting for one
    }
  } else if (stream_.Wait(deadline) == ClientStream::Event::kGone) {
    answered_ = true;
    call_->OnCancelled();
  }
}

void WebCall::HandOverRequest() {
  if (request_is_read_ && request_.content_bytes > 0) {
    call_->OnRequest(std::nullopt);  // the client has no more to say
    return;
  }
  Result<std::string> message = ReadRequest();
  bool already_finished = false;
  {
    MutexLock lock(mutex_);
    receiving_ = false;
    already_finished = step_.finish.has_value();
  }
  if (message) {
    call_->OnRequest(std::move(*message));
  } else if (!already_finished) {
    GiveUp(message.error());
  }
}

Result<std::string> WebCall::ReadRequest() {
  const uint64_t size = request_.content_bytes;
  if (size > limits_.request_bytes) {
    return ResourceExhausted(
        Str("the request has ", size, " bytes, this server takes at most ", limits_.request_bytes));
  }
  const Share share(memory_in_use_, size);
  if (memory_in_use_ > limits_.memory_bytes) {
    return ResourceExhausted("the server is busy with other requests; try again shortly")
        .WithReason("OVERLOADED");
  }
  std::optional<std::string> body = reader_.ReadBody(size, Deadline(clock_, limits_.request_time));
  if (!body) {
    usable_ = false;
    return Cancelled(
        Str("the request did not come whole, or not within ", limits_.request_time.count(), " ms"));
  }
  request_is_read_ = true;
  return MessageOf(std::move(*body));
}

bool WebCall::SkipRequest() {
  if (!usable_ || request_is_read_) return usable_;
  return reader_.ReadBody(request_.content_bytes, Deadline(clock_, limits_.request_time))
      .has_value();
}

void WebCall::GiveUp(const Status& status) {
  Write(std::nullopt, status);
  call_->OnCancelled();
}

bool WebCall::Write(const std::optional<WireMessage>& message,
                    const std::optional<Status>& status) {
  answered_ = answered_ || status.has_value();
  // What is left of the request would be taken for the next one.
  const bool request_goes = request_is_read_ || request_.content_bytes <= kSkippedBytes;
  usable_ = usable_ && request_goes && request_.keep_alive;
  std::vector<std::string> own;  // what is not the message's
  own.reserve(4);
  std::vector<std::string_view> pieces;
  const auto add = [&](std::string text) {
    pieces.emplace_back(own.emplace_back(std::move(text)));
  };
  if (!head_is_sent_) {
    add(ResponseHead(200,
                     {{"Content-Type", std::string(kGrpcWebType)},
                      {"Cache-Control", "no-store"},
                      {"Transfer-Encoding", "chunked"}},
                     usable_));
    head_is_sent_ = true;
  }
  if (message) {
    const std::string prefix = MessagePrefix(SizeBytes(*message));
    add(ChunkHead(prefix.size() + SizeBytes(*message)) + prefix);
    for (const WireSlice& slice : *message) {
      pieces.emplace_back(static_cast<const char*>(slice.data), slice.size_bytes);
    }
    pieces.emplace_back("\r\n");
  }
  if (status) {
    const std::string frame = TrailerFrame(*status);
    add(ChunkHead(frame.size()) + frame + "\r\n0\r\n\r\n");
  }
  const bool sent = stream_.Write(pieces, limits_.unread);
  if (!sent) usable_ = false;
  return sent;
}

void WebCall::Receive() { Ask({.receive = true}); }
void WebCall::Send(WireMessage message) { Ask({.send = std::move(message)}); }
void WebCall::SendAndFinish(WireMessage message) {
  Ask({.send = std::move(message), .finish = Status()});
}
void WebCall::Finish(const Status& status) { Ask({.finish = status}); }
void WebCall::Abort() { stream_.Cut(); }

void WebCall::Ask(Step step) {
  {
    MutexLock lock(mutex_);
    // A request that was asked for is not wanted any more when the call ends meanwhile.
    if (receiving_) stream_.StopReading();
    step_ = std::move(step);
  }
  stream_.Wake();
}

WebCall::Step WebCall::TakeStep() {
  MutexLock lock(mutex_);
  receiving_ = step_.receive;
  return std::exchange(step_, Step());
}

}  // namespace vs
