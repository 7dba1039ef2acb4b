#include "server/http/client_stream.h"

#include <linux/sockios.h>
#include <openssl/err.h>
#include <openssl/ssl.h>
#include <poll.h>
#include <sys/eventfd.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <sys/uio.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdint>
#include <cstring>
#include <limits>
#include <utility>

namespace vs {
namespace {

constexpr size_t kTlsRecordBytes = 16 << 10;
constexpr size_t kPiecesAtOnce = 64;
// What a client that is being refused may still send before the connection goes.
constexpr size_t kFarewellBytes = 1 << 20;
constexpr std::chrono::seconds kFarewell{1};

int ToPollMs(const Deadline& deadline) {
  constexpr int64_t kLongest = std::numeric_limits<int>::max();
  return static_cast<int>(std::min<int64_t>(deadline.Left().count(), kLongest));
}

// Drops the first `count` bytes.
void Advance(std::span<const std::string_view>& pieces, size_t& offset, size_t count) {
  offset += count;
  while (!pieces.empty() && offset >= pieces.front().size()) {
    offset -= pieces.front().size();
    pieces = pieces.subspan(1);
  }
}

// Of what was written: which the client has not acknowledged.
int UnreadBytes(int fd) {
  int count = 0;
  return ::ioctl(fd, SIOCOUTQ, &count) == 0 ? count : 0;
}

}  // namespace

void ClientStream::FreeTls::operator()(ssl_st* tls) const { SSL_free(tls); }

ClientStream::ClientStream(int fd, const Clock& clock)
    : clock_(clock), fd_(fd), wake_event_(::eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK)) {
  // Without it nobody could interrupt: such a connection ends at its first step.
  if (wake_event_ < 0) cut_ = true;
}

ClientStream::~ClientStream() {
  Close();
  if (wake_event_ >= 0) ::close(wake_event_);
}

void ClientStream::Close() {
  tls_.reset();
  if (fd_ >= 0) ::close(std::exchange(fd_, -1));
}

std::optional<char> ClientStream::Peek(const Deadline& deadline) {
  char first = 0;
  while (Poll(POLLIN, Purpose::kReading, deadline)) {
    const ssize_t count = ::recv(fd_, &first, 1, MSG_PEEK);
    if (count == 1) return first;
    if (count == 0 || (errno != EAGAIN && errno != EINTR)) break;
  }
  return std::nullopt;
}

bool ClientStream::StartTls(ssl_ctx_st* context, const Deadline& deadline) {
  tls_.reset(SSL_new(context));
  if (!tls_ || SSL_set_fd(tls_.get(), fd_) != 1) return false;
  const auto await = [&](short events) { return Poll(events, Purpose::kReading, deadline); };
  return Tls(Purpose::kReading, await, [&] { return SSL_accept(tls_.get()); }) > 0;
}

bool ClientStream::AwaitData(const Deadline& deadline) {
  if (tls_ && SSL_pending(tls_.get()) > 0) return MayContinue(Purpose::kReading);
  return Poll(POLLIN, Purpose::kReading, deadline);
}

size_t ClientStream::Read(void* data, size_t size, const Deadline& deadline) {
  if (tls_) {
    const auto most = static_cast<int>(std::min<size_t>(size, std::numeric_limits<int>::max()));
    const auto await = [&](short events) { return Poll(events, Purpose::kReading, deadline); };
    return static_cast<size_t>(
        Tls(Purpose::kReading, await, [&] { return SSL_read(tls_.get(), data, most); }));
  }
  while (MayContinue(Purpose::kReading)) {
    const ssize_t count = ::recv(fd_, data, size, 0);
    if (count >= 0) return static_cast<size_t>(count);
    if (errno == EINTR) continue;
    if (errno != EAGAIN || !Poll(POLLIN, Purpose::kReading, deadline)) break;
  }
  return 0;
}

bool ClientStream::Write(std::span<const std::string_view> pieces, const Patience& patience) {
  size_t size = 0;
  for (const std::string_view piece : pieces) size += piece.size();
  const Pace pace{patience.silence, Deadline(clock_, patience.For(size))};
  return tls_ ? WriteTls(pieces, pace) : WritePlain(pieces, pace);
}

bool ClientStream::WritePlain(std::span<const std::string_view> pieces, const Pace& pace) {
  size_t offset = 0;  // within the first piece
  Advance(pieces, offset, 0);
  while (!pieces.empty()) {
    if (!MayContinue(Purpose::kWriting)) return false;
    std::array<iovec, kPiecesAtOnce> vectors{};
    const size_t count = std::min(pieces.size(), vectors.size());
    for (size_t i = 0; i < count; ++i) {
      vectors[i] = {const_cast<char*>(pieces[i].data()), pieces[i].size()};
    }
    vectors[0].iov_base = static_cast<char*>(vectors[0].iov_base) + offset;
    vectors[0].iov_len -= offset;
    msghdr message{};
    message.msg_iov = vectors.data();
    message.msg_iovlen = count;
    const ssize_t sent = ::sendmsg(fd_, &message, MSG_NOSIGNAL);
    if (sent >= 0) {
      Advance(pieces, offset, static_cast<size_t>(sent));
    } else if (errno == EAGAIN) {
      if (!AwaitReader(POLLOUT, pace)) return false;
    } else if (errno != EINTR) {
      return false;
    }
  }
  return true;
}

bool ClientStream::WriteTls(std::span<const std::string_view> pieces, const Pace& pace) {
  const auto await = [&](short events) { return AwaitReader(events, pace); };
  std::array<char, kTlsRecordBytes> gathered;  // NOLINT(*-member-init): filled before it is sent
  size_t offset = 0;
  Advance(pieces, offset, 0);
  while (!pieces.empty()) {
    // Small pieces share a record; of a large one, each record is encrypted where it lies.
    const char* record = pieces.front().data() + offset;
    size_t size = std::min(pieces.front().size() - offset, kTlsRecordBytes);
    if (size < kTlsRecordBytes) {
      size = 0;
      size_t skip = offset;
      for (size_t i = 0; i < pieces.size() && size < gathered.size(); ++i) {
        const std::string_view piece = pieces[i].substr(skip, gathered.size() - size);
        skip = 0;
        if (piece.empty()) continue;  // perhaps without an address
        std::memcpy(gathered.data() + size, piece.data(), piece.size());
        size += piece.size();
      }
      record = gathered.data();
    }
    const int sent = Tls(Purpose::kWriting, await,
                         [&] { return SSL_write(tls_.get(), record, static_cast<int>(size)); });
    if (sent <= 0) return false;
    Advance(pieces, offset, static_cast<size_t>(sent));
  }
  return true;
}

void ClientStream::CloseGently() {
  if (cut_) return;
  const Deadline deadline(clock_, kFarewell);
  if (tls_ && SSL_is_init_finished(tls_.get()) == 1) SSL_shutdown(tls_.get());
  ::shutdown(fd_, SHUT_WR);
  std::array<char, 16 << 10> ignored{};
  size_t taken = 0;
  while (taken < kFarewellBytes && MayContinue(Purpose::kReading)) {
    const ssize_t count = ::recv(fd_, ignored.data(), ignored.size(), 0);
    if (count > 0) {
      taken += static_cast<size_t>(count);
    } else if (count == 0 || (errno != EAGAIN && errno != EINTR) ||
               !Poll(POLLIN, Purpose::kReading, deadline)) {
      return;
    }
  }
}

ClientStream::Event ClientStream::Wait(const Deadline& deadline) {
  while (!cut_) {
    if (deadline.Passed()) return Event::kTimeout;
    std::array<pollfd, 2> waiting = {pollfd{fd_, POLLRDHUP, 0}, pollfd{wake_event_, POLLIN, 0}};
    if (::poll(waiting.data(), waiting.size(), ToPollMs(deadline)) < 0) continue;
    if (waiting[1].revents != 0 && TakeWake()) return cut_ ? Event::kGone : Event::kWoken;
    if (waiting[0].revents != 0) return Event::kGone;
  }
  return Event::kGone;
}

void ClientStream::WaitForWake() {
  pollfd waiting{wake_event_, POLLIN, 0};
  while (!TakeWake()) ::poll(&waiting, 1, -1);
}

bool ClientStream::Poll(short events, Purpose purpose, const Deadline& deadline) {
  while (MayContinue(purpose) && !deadline.Passed()) {
    std::array<pollfd, 2> waiting = {pollfd{fd_, events, 0}, pollfd{wake_event_, POLLIN, 0}};
    if (::poll(waiting.data(), waiting.size(), ToPollMs(deadline)) < 0) continue;
    // Whoever waits for a wake looks for what is new before it waits again.
    if (waiting[1].revents != 0) TakeWake();
    if (waiting[0].revents != 0) return MayContinue(purpose);
  }
  return false;
}

bool ClientStream::AwaitReader(short events, const Pace& pace) {
  // The kernel makes room only after a good part of its buffer is read, which takes a slow client
  // longer than it may be silent. So what has been read is looked at, too.
  int unread_before = UnreadBytes(fd_);
  while (true) {
    const Deadline silent(clock_, std::min(pace.silence, pace.whole.Left()));
    if (Poll(events, Purpose::kWriting, silent)) return true;
    const int unread = UnreadBytes(fd_);
    if (!MayContinue(Purpose::kWriting) || pace.whole.Passed() || unread >= unread_before) {
      return false;
    }
    unread_before = unread;
  }
}

bool ClientStream::MayContinue(Purpose purpose) const {
  return !cut_ && !(purpose == Purpose::kReading && reading_stopped_);
}

template <class Await, class Operation>
int ClientStream::Tls(Purpose purpose, Await await, Operation operation) {
  while (MayContinue(purpose)) {
    ERR_clear_error();
    const int result = operation();
    if (result > 0) return result;
    switch (SSL_get_error(tls_.get(), result)) {
      case SSL_ERROR_WANT_READ:
        if (!await(POLLIN)) return 0;
        break;
      case SSL_ERROR_WANT_WRITE:
        if (!await(POLLOUT)) return 0;
        break;
      default:
        return 0;
    }
  }
  return 0;
}

bool ClientStream::TakeWake() {
  uint64_t count = 0;
  return ::read(wake_event_, &count, sizeof count) == sizeof count;
}

void ClientStream::Wake() {
  const uint64_t one = 1;
  [[maybe_unused]] const ssize_t written = ::write(wake_event_, &one, sizeof one);
}

void ClientStream::StopReading() {
  reading_stopped_ = true;
  Wake();
}

void ClientStream::Cut() {
  cut_ = true;
  Wake();
}

}  // namespace vs
