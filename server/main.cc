// visionserver: starts a server from its configuration file and runs it until SIGTERM.

#include <malloc.h>
#include <pthread.h>
#include <sys/resource.h>
#include <unistd.h>

#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <exception>
#include <filesystem>
#include <string>

#include <CLI/CLI.hpp>

#include "engine/base/log.h"
#include "engine/base/str.h"
#include "server/server.h"
#include "server/version.h"

namespace vs {
namespace {

constexpr int kExitFailure = 1;
constexpr int kExitBadConfig = 2;  // or a command line that makes no sense
constexpr unsigned int kEndS = 10;

// A frame is larger than what malloc takes from its heap at first: each one would be mapped and
// page by page touched anew, which costs more than all the rest of sending it.
void KeepFreedMemory() {
  mallopt(M_MMAP_THRESHOLD, 64 << 20);
  mallopt(M_TRIM_THRESHOLD, 256 << 20);
}

// Each connection and camera needs a file.
void RaiseFileLimit() {
  rlimit limit{};
  if (getrlimit(RLIMIT_NOFILE, &limit) != 0) return;
  limit.rlim_cur = limit.rlim_max;
  setrlimit(RLIMIT_NOFILE, &limit);
}

LogLevel ToLogLevel(config::ServerConfig::LogLevel level) {
  switch (level) {
    case config::ServerConfig::DEBUG:
      return LogLevel::kDebug;
    case config::ServerConfig::INFO:
      return LogLevel::kInfo;
    case config::ServerConfig::WARN:
      return LogLevel::kWarn;
    case config::ServerConfig::ERROR:
      return LogLevel::kError;
  }
  return LogLevel::kInfo;
}

// The folder "web" beside that of the programs, where a build or an installation puts the page.
std::filesystem::path DefaultWebRoot() {
  std::error_code error;
  const std::filesystem::path program = std::filesystem::read_symlink("/proc/self/exe", error);
  return program.parent_path().parent_path() / "web";
}

// For people and for the scripts that start a server: on standard output, once.
void Greet(const Server& server) {
  std::printf("VisionServer %s listens on %s%s\n", kVersion, server.address().c_str(),
              server.fingerprint().empty() ? " (plain text)" : "");
  if (const std::string page = server.PageAddress(); !page.empty()) {
    std::printf("the page is at %s\n", page.c_str());
  }
  if (!server.fingerprint().empty()) {
    std::printf("certificate fingerprint (SHA-256): %s\n", server.fingerprint().c_str());
  }
  if (server.one_time_password()) {
    std::printf("one-time password of the user admin, valid for 24 hours: %s\n",
                server.one_time_password()->c_str());
  }
  std::fflush(stdout);
}

// One line for each sequence that has completed a frame without error: "stereo_depth: 9.8 fps, 85
// ms latency, 42 frames, 0 dropped".
void Report(Server& server) {
  for (const SequenceStatus& status : server.vision().sequences().List()) {
    const RunStats& stats = status.stats;
    const uint64_t good_frames = stats.frames - stats.failed_frames;
    if (good_frames == 0) continue;
    std::printf("%s: %.1f fps, %.0f ms latency, %llu frames, %llu dropped\n", status.id.c_str(),
                stats.frames_per_second, static_cast<double>(stats.latency_p50_ns) / 1e6,
                static_cast<unsigned long long>(good_frames),
                static_cast<unsigned long long>(stats.dropped));
  }
  std::fflush(stdout);
}

// Until one of `signals` comes; reports meanwhile if that is asked for.
void WaitForSignal(const sigset_t& signals, int report_s, Server& server) {
  while (true) {
    int signal = 0;
    if (report_s == 0) {
      if (sigwait(&signals, &signal) == 0) return;
      continue;
    }
    const timespec period{.tv_sec = report_s, .tv_nsec = 0};
    if (sigtimedwait(&signals, nullptr, &period) >= 0) return;
    Report(server);
  }
}

// Ends the process after this time even if something cannot be stopped.
void EndWithin(unsigned int seconds) {
  std::signal(SIGALRM, [](int) {
    static constexpr char kMessage[] = "visionserver: something did not stop in time\n";
    [[maybe_unused]] const auto written = write(STDERR_FILENO, kMessage, sizeof kMessage - 1);
    _exit(kExitFailure);
  });
  alarm(seconds);
}

int Fail(const Status& status, int exit_code) {
  std::fprintf(stderr, "visionserver: %s\n", status.ToString().c_str());
  return exit_code;
}

int RunProgram(int argument_count, char** arguments) {
  CLI::App app("VisionServer: networked 3D machine vision", "visionserver");
  std::string config_file;
  bool check_config = false;
  bool rescue_admin = false;
  bool no_web = false;
  std::string web_root = DefaultWebRoot().string();
  int report_s = 0;
  app.add_option("--config", config_file, "The configuration file")->required();
  app.add_flag("--check-config", check_config,
               "Only check the configuration and print it with all defaults");
  app.add_flag("--rescue-admin", rescue_admin,
               "Give the user admin a new one-time password and print it");
  app.add_flag("--no-web", no_web, "Serve no page for browsers");
  app.add_option("--web-root", web_root, "The folder with the files of the page")
      ->check(CLI::ExistingDirectory);
  app.add_option("--report", report_s,
                 "Print the rate of each running sequence every so many seconds")
      ->check(CLI::Range(1, 3600));
  app.set_version_flag("--version", kVersion);
  try {
    app.parse(argument_count, arguments);
  } catch (const CLI::Success& answered) {  // help or version
    return app.exit(answered);
  } catch (const CLI::ParseError& error) {
    return Fail(InvalidArgument(Str(error.what(), " (visionserver --help says more)")),
                kExitBadConfig);
  }

  Result<config::ServerConfig> config = LoadConfig(config_file);
  if (!config) return Fail(config.error(), kExitBadConfig);
  if (no_web) config->set_web_address("");
  if (check_config) {
    std::fputs(Describe(*config).c_str(), stdout);
    return EXIT_SUCCESS;
  }
  SetLogLevel(ToLogLevel(config->log_level()));

  // Before there are other threads, so that they all inherit it: the signals are waited for here.
  sigset_t signals;
  sigemptyset(&signals);
  sigaddset(&signals, SIGTERM);
  sigaddset(&signals, SIGINT);
  pthread_sigmask(SIG_BLOCK, &signals, nullptr);
  std::signal(SIGPIPE, SIG_IGN);
  KeepFreedMemory();
  RaiseFileLimit();

  Result<std::unique_ptr<Server>> server =
      Server::Start({.config = *config, .rescue_admin = rescue_admin, .web_root = web_root});
  if (!server) return Fail(server.error(), kExitFailure);
  Greet(**server);

  WaitForSignal(signals, report_s, **server);
  LogInfo("server", "shutting down; once more to do so at once");
  // Whoever asks twice does not want to wait.
  pthread_sigmask(SIG_UNBLOCK, &signals, nullptr);
  EndWithin(kEndS);
  (*server)->Drain();
  server->reset();
  return EXIT_SUCCESS;
}

}  // namespace
}  // namespace vs

int main(int argument_count, char** arguments) {
  try {
    return vs::RunProgram(argument_count, arguments);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "visionserver: %s\n", error.what());
    return vs::kExitFailure;
  }
}
