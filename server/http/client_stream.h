#pragma once

#include <atomic>
#include <chrono>
#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <string_view>

#include "engine/base/clock.h"
#include "engine/base/deadline.h"
#include "server/rpc/patience.h"

struct ssl_ctx_st;
struct ssl_st;

namespace vs {

// A client's TCP connection, plain or through TLS, on which nothing waits longer than it may: every
// step has a deadline, and other threads can interrupt it. (Boost.Asio's synchronous streams know
// neither.)
//
// One thread reads, writes and waits; Wake, StopReading and Cut may be called from any.
class ClientStream {
 public:
  // Owns `fd`, which does not block. `clock` must outlive it.
  ClientStream(int fd, const Clock& clock);
  ~ClientStream();
  ClientStream(const ClientStream&) = delete;
  ClientStream& operator=(const ClientStream&) = delete;

  // The first byte without taking it; nothing when none comes.
  std::optional<char> Peek(const Deadline& deadline);
  // From now on everything goes through TLS. False: the handshake failed.
  bool StartTls(ssl_ctx_st* context, const Deadline& deadline);

  // Waits for something to read; false when nothing comes.
  bool AwaitData(const Deadline& deadline);
  // At least one byte and at most `size`. 0: the client has closed, time is over, or another thread
  // ended it.
  size_t Read(void* data, size_t size, const Deadline& deadline);
  // All pieces, in order. False: the client has gone, another thread cut it, or it does not read:
  // nothing for as long as `patience` says (found out within twice that), or not all in the time
  // for so many bytes.
  bool Write(std::span<const std::string_view> pieces, const Patience& patience);
  // Ends the connection so that the client still gets what was written: without reading on for a
  // moment, a reset would overtake it.
  void CloseGently();
  // Nothing but Wake and its like may be called after it.
  void Close();
  int fd() const { return fd_; }

  enum class Event { kWoken, kGone, kTimeout };
  // Until Wake, until the client has closed its side or was cut off, or the deadline.
  Event Wait(const Deadline& deadline);
  // Until Wake.
  void WaitForWake();

  // Ends a Wait under way, or the next one.
  void Wake();
  // No more is read: a read under way, and each after it, gives nothing.
  void StopReading();
  // Nothing goes either way any more.
  void Cut();

 private:
  enum class Purpose { kReading, kWriting };
  // Until the socket has one of `events`. False: the deadline, or ended by another thread.
  bool Poll(short events, Purpose purpose, const Deadline& deadline);
  bool MayContinue(Purpose purpose) const;
  bool TakeWake();
  // Repeats an operation of OpenSSL until it is done; what it returned, or 0 when it failed.
  template <class Await, class Operation>
  int Tls(Purpose purpose, Await await, Operation operation);
  // What the writing of some pieces is held to.
  struct Pace {
    std::chrono::milliseconds silence;
    Deadline whole;
  };
  // Until the socket has one of `events`, while the client reads.
  bool AwaitReader(short events, const Pace& pace);
  bool WritePlain(std::span<const std::string_view> pieces, const Pace& pace);
  bool WriteTls(std::span<const std::string_view> pieces, const Pace& pace);

  struct FreeTls {
    void operator()(ssl_st* tls) const;
  };

  const Clock& clock_;
  int fd_;
  const int wake_event_;
  std::unique_ptr<ssl_st, FreeTls> tls_;
  std::atomic<bool> reading_stopped_{false};
  std::atomic<bool> cut_{false};
};

}  // namespace vs
