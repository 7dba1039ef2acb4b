#pragma once

#include <chrono>
#include <csignal>

namespace vs::cli {

// While it lives, Ctrl-C and SIGTERM only ask a command that runs on and on to come to its end.
class Interrupt {
 public:
  // How often such a command looks.
  static constexpr std::chrono::milliseconds kGlance{100};

  Interrupt() {
    requested_ = 0;
    before_int_ = std::signal(SIGINT, [](int) { requested_ = 1; });
    before_term_ = std::signal(SIGTERM, [](int) { requested_ = 1; });
  }
  ~Interrupt() {
    std::signal(SIGINT, before_int_);
    std::signal(SIGTERM, before_term_);
  }
  Interrupt(const Interrupt&) = delete;
  Interrupt& operator=(const Interrupt&) = delete;

  bool requested() const { return requested_ != 0; }

 private:
  inline static volatile std::sig_atomic_t requested_ = 0;
  void (*before_int_)(int);
  void (*before_term_)(int);
};

}  // namespace vs::cli
