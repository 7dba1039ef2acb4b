#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <stop_token>
#include <string>

#include "engine/base/mutex.h"
#include "engine/base/status.h"
#include "server/rpc/call.h"
#include "server/rpc/router.h"
#include "server/rpc/stream_source.h"
#include "server/rpc/wire_message.h"

namespace vs {

class Dispatcher;

// The network's half of one call. Functions are called from any thread, never two at once; after
// Finish or SendAndFinish only Abort, and nothing after ServerCall::OnDone.
class Channel {
 public:
  virtual ~Channel() = default;

  // Reads the next request; ServerCall::OnRequest follows.
  virtual void Receive() = 0;
  // ServerCall::OnSent follows.
  virtual void Send(WireMessage message) = 0;
  virtual void SendAndFinish(WireMessage message) = 0;
  virtual void Finish(const Status& status) = 0;
  // Breaks the call off; what is under way fails soon.
  virtual void Abort() = 0;
};

// One call from its first byte to its last: runs the handler where it belongs, asks a stream's
// source for its messages, and ends the call when the client leaves, does not read, loses its
// rights, or the server shuts down.
//
// The network calls the On... functions; they may come from any thread and never wait.
class ServerCall : public std::enable_shared_from_this<ServerCall> {
 public:
  // `recorded`: the dispatcher's auditor is told of it. `method` is null when there is no such one.
  ServerCall(Dispatcher& dispatcher, const Method* method, Call call, bool recorded,
             Channel& channel);
  ~ServerCall();
  ServerCall(const ServerCall&) = delete;
  ServerCall& operator=(const ServerCall&) = delete;

  // Nothing: the client has closed its side.
  void OnRequest(std::optional<std::string> bytes);
  // False: the client is gone.
  void OnSent(bool ok);
  // The client has gone or the deadline has passed.
  void OnCancelled();
  // All is sent or has failed: the channel goes.
  void OnDone();

  // For the dispatcher: begins by reading the request, or refuses.
  void Begin();
  void Refuse(const Status& status);
  // For the dispatcher, several times a second while the call is an open stream: may it go on?
  void Recheck();
  // For the dispatcher, several times a second.
  void CutOffIfUnread(int64_t now_ns);
  // Ends an open stream as soon as its current message is out; tells a handler to stop.
  void End(const Status& status);
  const Call& call() const { return call_; }
  bool recorded() const { return recorded_; }

 private:
  // kDone: the answer or the status is on its way or there.
  enum class Phase { kReceiving, kWorking, kWaiting, kSending, kDone };
  struct Waker;

  void RunHandler(const std::string& request);
  void Answer(const std::string& request);
  void OpenSource(const std::string& request);
  // Asks the source for its next steps until it has to wait or has a message; in kWorking.
  void Pump();
  // True: the source has nothing to say now, and the call waits.
  bool RestUntil(std::optional<int64_t> until_ns) VS_EXCLUDES(mutex_);
  void OnWake() VS_EXCLUDES(mutex_);
  void SendNext(WireMessage message) VS_EXCLUDES(mutex_);
  std::optional<Status> ReasonToEnd() VS_EXCLUDES(mutex_);
  void FinishIfAtRest(const Status& status) VS_EXCLUDES(mutex_);
  void FinishWith(const Status& status) VS_EXCLUDES(mutex_);
  void Close(const Status& status, std::optional<WireMessage> last_message) VS_REQUIRES(mutex_);
  // Runs code of a service; what it throws ends the call, not the server.
  template <class Function>
  void Guarded(Function function);

  Dispatcher& dispatcher_;
  const Method* const method_;  // null when there is no such method
  Call call_;
  bool recorded_;
  std::stop_source cancelled_;
  const std::shared_ptr<Waker> waker_;

  Mutex mutex_;
  Channel* channel_ VS_GUARDED_BY(mutex_);  // null when the network is done
  Phase phase_ VS_GUARDED_BY(mutex_) = Phase::kReceiving;
  std::optional<Status> ending_ VS_GUARDED_BY(mutex_);  // why it ends at the next chance
  int64_t ending_since_ns_ VS_GUARDED_BY(mutex_) = 0;
  int64_t sending_since_ns_ VS_GUARDED_BY(mutex_) = 0;
  size_t sending_bytes_ VS_GUARDED_BY(mutex_) = 0;
  int64_t timer_ns_ VS_GUARDED_BY(mutex_) = 0;  // the next wake that was asked of the timer
  bool sent_something_ VS_GUARDED_BY(mutex_) = false;
  bool cut_off_ VS_GUARDED_BY(mutex_) = false;
  // Touched only in kWorking, by the one thread that works.
  std::unique_ptr<StreamSource> source_;
};

}  // namespace vs
