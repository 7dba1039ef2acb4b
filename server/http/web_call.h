#pragma once

#include <atomic>
#include <chrono>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "engine/base/clock.h"
#include "engine/base/mutex.h"
#include "server/http/client_stream.h"
#include "server/http/http_message.h"
#include "server/http/request_reader.h"
#include "server/rpc/dispatcher.h"
#include "server/rpc/patience.h"

namespace vs {

struct WebCallLimits {
  size_t request_bytes = size_t{4} << 20;
  // A request must have come whole by then.
  std::chrono::milliseconds request_time{30'000};
  // A client that does not read a message loses its call.
  Patience unread;
  // For the requests of all connections that are being received.
  size_t memory_bytes = size_t{512} << 20;
};

// One gRPC-Web call, from the head of its request on: the dispatcher's channel that speaks HTTP.
//
// The dispatcher's threads only leave word here what is to be sent; the connection's own thread
// does it, so that none of theirs waits for a client.
class WebCall final : public Channel {
 public:
  // All must outlive it. `memory_in_use` is shared by all calls.
  WebCall(ClientStream& stream, RequestReader& reader, const HttpRequest& request,
          const WebCallLimits& limits, std::atomic<size_t>& memory_in_use);

  // Returns when the dispatcher is done with the call. False: the connection must go.
  bool Run(Dispatcher& dispatcher, const std::string& client_address);

  void Receive() override;
  void Send(WireMessage message) override;
  void SendAndFinish(WireMessage message) override;
  void Finish(const Status& status) override;
  void Abort() override;

 private:
  // What the dispatcher wants done next.
  struct Step {
    bool receive = false;
    std::optional<WireMessage> send;
    std::optional<Status> finish;
    bool Nothing() const { return !receive && !send && !finish; }
  };

  void Ask(Step step) VS_EXCLUDES(mutex_);
  Step TakeStep() VS_EXCLUDES(mutex_);
  void Do(const Step& step);
  void WaitForStep(const Deadline& deadline);
  void HandOverRequest();
  Result<std::string> ReadRequest();
  // After the answer, reads a request that nobody wanted. True: the connection can be used on.
  bool SkipRequest();
  // The call ends with `status`, whatever the dispatcher says.
  void GiveUp(const Status& status);
  // Either may be absent; with a status the answer is complete. False: it cannot be sent.
  bool Write(const std::optional<WireMessage>& message, const std::optional<Status>& status);

  ClientStream& stream_;
  RequestReader& reader_;
  const HttpRequest& request_;
  const WebCallLimits& limits_;
  std::atomic<size_t>& memory_in_use_;
  const SystemClock clock_;

  Mutex mutex_;
  Step step_ VS_GUARDED_BY(mutex_);
  bool receiving_ VS_GUARDED_BY(mutex_) = false;  // the request is being read

  // Of the connection's thread.
  std::shared_ptr<ServerCall> call_;
  bool request_is_read_;
  bool head_is_sent_ = false;
  bool answered_ = false;  // completely, or given up
  bool usable_ = true;     // the connection, after this call
  bool closed_ = false;    // the connection, before the dispatcher is done
};

}  // namespace vs
