#include "client/cli/password.h"

#include <fcntl.h>
#include <termios.h>
#include <unistd.h>

#include <array>
#include <csignal>
#include <iostream>

namespace vs::cli {
namespace {

// While it lives, the terminal shows nothing of what is typed.
class SilentTerminal {
 public:
  explicit SilentTerminal(int fd) : fd_(fd) {
    known_ = ::tcgetattr(fd_, &before_) == 0;
    termios silent = before_;
    silent.c_lflag &= ~static_cast<tcflag_t>(ECHO);
    if (known_) ::tcsetattr(fd_, TCSAFLUSH, &silent);
  }
  ~SilentTerminal() {
    if (known_) ::tcsetattr(fd_, TCSAFLUSH, &before_);
  }
  SilentTerminal(const SilentTerminal&) = delete;
  SilentTerminal& operator=(const SilentTerminal&) = delete;

 private:
  int fd_;
  bool known_;
  termios before_{};
};

// While it lives, a signal that would end the program only interrupts `read`, so that the terminal
// is never left silent.
class InterruptedReads {
 public:
  InterruptedReads() {
    struct sigaction interrupt {};
    interrupt.sa_handler = [](int) {};
    for (size_t i = 0; i < kSignals.size(); ++i) ::sigaction(kSignals[i], &interrupt, &before_[i]);
  }
  ~InterruptedReads() {
    for (size_t i = 0; i < kSignals.size(); ++i) ::sigaction(kSignals[i], &before_[i], nullptr);
  }
  InterruptedReads(const InterruptedReads&) = delete;
  InterruptedReads& operator=(const InterruptedReads&) = delete;

 private:
  static constexpr std::array<int, 4> kSignals = {SIGINT, SIGTERM, SIGHUP, SIGTSTP};
  std::array<struct sigaction, kSignals.size()> before_{};
};

}  // namespace

client::Result<std::string> AskPassword(const std::string& question, const std::string& instead) {
  const int fd = ::open("/dev/tty", O_RDWR | O_CLOEXEC);
  if (fd < 0) {
    return client::Failure(client::Code::kFailedPrecondition,
                           "there is no terminal to ask for a password; use " + instead);
  }
  std::string password;
  ssize_t got = 0;
  {
    const InterruptedReads interrupted;
    const SilentTerminal silent(fd);
    const std::string prompt = question + ": ";
    (void)!::write(fd, prompt.data(), prompt.size());
    char c = 0;
    while ((got = ::read(fd, &c, 1)) == 1 && c != '\n') password += c;
    (void)!::write(fd, "\n", 1);
  }
  ::close(fd);
  if (got != 1) return client::Failure(client::Code::kCancelled, "no password was given");
  return password;
}

client::Result<std::string> ReadPasswordLine() {
  std::string password;
  if (std::getline(std::cin, password) && !password.empty()) return password;
  return client::Failure(client::Code::kInvalidArgument,
                         "standard input holds no (further) password; give one a line");
}

}  // namespace vs::cli
