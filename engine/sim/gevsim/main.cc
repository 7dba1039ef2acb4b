// gevsim: a simulated stereo rig of two GigE Vision cameras, for everything that has none.

#include <poll.h>
#include <signal.h>
#include <sys/signalfd.h>

#include <algorithm>
#include <cstdio>

#include "engine/base/log.h"
#include "engine/sim/gevsim/options.h"
#include "engine/sim/gevsim/rig.h"

namespace vs::sim {
namespace {

// SIGINT and SIGTERM as something to wait for. To be called before any thread starts.
int CatchSignals() {
  sigset_t ends;
  sigemptyset(&ends);
  sigaddset(&ends, SIGINT);
  sigaddset(&ends, SIGTERM);
  sigprocmask(SIG_BLOCK, &ends, nullptr);
  signal(SIGPIPE, SIG_IGN);
  return signalfd(-1, &ends, SFD_CLOEXEC);
}

int Main(int argc, char** argv) {
  const auto [options, exit_code] = ParseOptions(argc, argv);
  if (exit_code) return *exit_code;
  pollfd ending = {CatchSignals(), POLLIN, 0};
  const auto rig = Rig::Start(options);
  if (!rig) {
    LogError("gevsim", rig.error().message());
    return 1;
  }
  for (const std::string& line : (*rig)->Greeting()) std::puts(line.c_str());
  std::puts("gevsim ready");
  std::fflush(stdout);
  const int wait_ms =
      options.duration_s > 0 ? static_cast<int>(std::min(options.duration_s * 1000, 2e9)) : -1;
  poll(&ending, 1, wait_ms);
  if (const auto statistics = (*rig)->Command("stats")) std::puts(statistics->c_str());
  return 0;
}

}  // namespace
}  // namespace vs::sim

int main(int argc, char** argv) { return vs::sim::Main(argc, argv); }
