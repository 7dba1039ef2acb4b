#include "tests/support/child_process.h"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <sys/eventfd.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <thread>

#include "engine/base/check.h"
#include "engine/base/mutex.h"
#include "engine/base/str.h"

namespace vs::test {
namespace {

using Clock = std::chrono::steady_clock;

// Owns a file descriptor.
class Descriptor {
 public:
  Descriptor() = default;
  explicit Descriptor(int fd) : fd_(fd) {}
  ~Descriptor() { Close(); }
  Descriptor(Descriptor&& other) noexcept : fd_(std::exchange(other.fd_, -1)) {}
  Descriptor& operator=(Descriptor&& other) noexcept {
    std::swap(fd_, other.fd_);
    return *this;
  }

  int Get() const { return fd_; }
  void Close() {
    if (fd_ >= 0) close(std::exchange(fd_, -1));
  }

 private:
  int fd_ = -1;
};

struct Pipe {
  Descriptor reader, writer;

  static Pipe Make() {
    int ends[2] = {-1, -1};
    VS_CHECK(pipe2(ends, O_CLOEXEC) == 0);
    return {Descriptor(ends[0]), Descriptor(ends[1])};
  }
};

// A file in memory, so that a program that does not read its input blocks nobody.
Descriptor InputOf(const std::string& text) {
  Descriptor file(memfd_create("stdin", MFD_CLOEXEC));
  VS_CHECK(file.Get() >= 0);
  VS_CHECK(write(file.Get(), text.data(), text.size()) == static_cast<ssize_t>(text.size()));
  VS_CHECK(lseek(file.Get(), 0, SEEK_SET) == 0);
  return file;
}

std::vector<char*> Pointers(std::vector<std::string>& strings) {
  std::vector<char*> pointers;
  pointers.reserve(strings.size() + 1);
  for (std::string& text : strings) pointers.push_back(text.data());
  pointers.push_back(nullptr);
  return pointers;
}

std::vector<std::string> EnvironmentWith(const std::map<std::string, std::string>& added) {
  std::vector<std::string> environment;
  for (char** entry = environ; *entry != nullptr; ++entry) {
    const std::string_view text(*entry);
    if (!added.contains(std::string(text.substr(0, text.find('=')))))
      environment.emplace_back(text);
  }
  for (const auto& [name, value] : added) environment.push_back(Str(name, "=", value));
  return environment;
}

// What runs between fork and exec: only calls that are safe there.
struct ChildSetup {
  int input, output, error, report;
  const char* directory;
  pid_t parent;
  char** arguments;
  char** environment;

  [[noreturn]] void Exec() const {
    setpgid(0, 0);
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    if (getppid() != parent) _exit(127);
    sigset_t none;
    sigemptyset(&none);
    sigprocmask(SIG_SETMASK, &none, nullptr);
    dup2(input, STDIN_FILENO);
    dup2(output, STDOUT_FILENO);
    dup2(error, STDERR_FILENO);
    if (directory[0] == '\0' || chdir(directory) == 0) {
      execvpe(arguments[0], arguments, environment);
    }
    const int reason = errno;
    [[maybe_unused]] const ssize_t told = write(report, &reason, sizeof reason);
    _exit(127);
  }
};

std::chrono::milliseconds Until(Clock::time_point deadline) {
  const auto left = std::chrono::ceil<std::chrono::milliseconds>(deadline - Clock::now());
  return std::max(left, std::chrono::milliseconds(0));
}

// Lines of `text` from `from` on; moves `from` behind the last whole line that was looked at.
std::optional<std::string> FindLine(const std::string& text, std::string_view part, bool ended,
                                    size_t* from) {
  while (*from < text.size()) {
    size_t end = text.find('\n', *from);
    if (end == std::string::npos) {
      if (!ended) return std::nullopt;
      end = text.size();
    }
    const std::string_view line(text.data() + *from, end - *from);
    *from = std::min(end + 1, text.size());
    if (line.find(part) != std::string_view::npos) return std::string(line);
  }
  return std::nullopt;
}

}  // namespace

struct ChildProcess::State {
  pid_t pid = -1;
  std::array<Descriptor, 2> sources;  // standard output and error
  Descriptor stop{eventfd(0, EFD_CLOEXEC)};
  std::thread reader;

  mutable Mutex mutex;
  CondVar changed;
  std::array<std::string, 2> text VS_GUARDED_BY(mutex);
  bool drained VS_GUARDED_BY(mutex) = false;
  std::optional<int> exit_code VS_GUARDED_BY(mutex);

  void Read() VS_EXCLUDES(mutex) {
    std::array<pollfd, 3> waiting = {
        {{sources[0].Get(), POLLIN, 0}, {sources[1].Get(), POLLIN, 0}, {stop.Get(), POLLIN, 0}}};
    while (waiting[0].fd >= 0 || waiting[1].fd >= 0) {
      poll(waiting.data(), waiting.size(), -1);
      if (waiting[2].revents != 0) break;
      for (size_t i = 0; i < sources.size(); ++i) {
        if (waiting[i].fd < 0 || waiting[i].revents == 0) continue;
        std::array<char, 4096> bytes;
        const ssize_t count = read(waiting[i].fd, bytes.data(), bytes.size());
        if (count <= 0) {
          waiting[i].fd = -1;
          continue;
        }
        MutexLock lock(mutex);
        text[i].append(bytes.data(), static_cast<size_t>(count));
        changed.NotifyAll();
      }
    }
    MutexLock lock(mutex);
    drained = true;
    changed.NotifyAll();
  }

  // True once the process has ended. It is left a zombie, so that its id, and that of its group,
  // name nobody else until the destructor is done with them.
  bool Ended() VS_REQUIRES(mutex) {
    siginfo_t info{};
    if (!exit_code &&
        waitid(P_PID, static_cast<id_t>(pid), &info, WEXITED | WNOHANG | WNOWAIT) == 0 &&
        info.si_pid == pid) {
      exit_code = info.si_code == CLD_EXITED ? info.si_status : 128 + info.si_status;
    }
    return exit_code.has_value();
  }
};

ChildProcess::ChildProcess(std::unique_ptr<State> state) : state_(std::move(state)) {}

Result<std::unique_ptr<ChildProcess>> ChildProcess::Start(const std::vector<std::string>& command,
                                                          const ProcessOptions& options) {
  VS_CHECK(!command.empty());
  std::vector<std::string> arguments = command;
  std::vector<std::string> environment = EnvironmentWith(options.environment);
  std::vector<char*> argument_pointers = Pointers(arguments);
  std::vector<char*> environment_pointers = Pointers(environment);
  const Descriptor input = InputOf(options.input);
  Pipe output = Pipe::Make();
  Pipe error = Pipe::Make();
  Pipe report = Pipe::Make();
  const ChildSetup setup{input.Get(),
                         output.writer.Get(),
                         error.writer.Get(),
                         report.writer.Get(),
                         options.directory.c_str(),
                         getpid(),
                         argument_pointers.data(),
                         environment_pointers.data()};
  const pid_t pid = fork();
  VS_CHECK(pid >= 0);
  if (pid == 0) setup.Exec();

  output.writer.Close();
  error.writer.Close();
  report.writer.Close();
  int reason = 0;
  if (read(report.reader.Get(), &reason, sizeof reason) == sizeof reason) {
    waitpid(pid, nullptr, 0);
    const std::string message = Str("cannot run ", command[0], ": ", std::strerror(reason));
    return reason == EACCES ? PermissionDenied(message) : NotFound(message);
  }
  auto state = std::make_unique<State>();
  state->pid = pid;
  state->sources = {std::move(output.reader), std::move(error.reader)};
  state->reader = std::thread([&s = *state] { s.Read(); });
  return std::unique_ptr<ChildProcess>(new ChildProcess(std::move(state)));
}

ChildProcess::~ChildProcess() {
  kill(-state_->pid, SIGKILL);
  waitpid(state_->pid, nullptr, 0);
  eventfd_write(state_->stop.Get(), 1);
  state_->reader.join();
}

pid_t ChildProcess::Pid() const { return state_->pid; }

std::optional<std::string> ChildProcess::WaitForLine(std::string_view text,
                                                     std::chrono::milliseconds patience) {
  const Clock::time_point deadline = Clock::now() + patience;
  std::array<size_t, 2> seen = {0, 0};
  MutexLock lock(state_->mutex);
  while (true) {
    const bool ended = state_->drained;
    for (size_t i = 0; i < seen.size(); ++i) {
      if (auto line = FindLine(state_->text[i], text, ended, &seen[i])) return line;
    }
    if (ended || Clock::now() >= deadline) return std::nullopt;
    state_->changed.WaitFor(state_->mutex, Until(deadline));
  }
}

std::string ChildProcess::Output() const {
  MutexLock lock(state_->mutex);
  return state_->text[0];
}

std::string ChildProcess::ErrorOutput() const {
  MutexLock lock(state_->mutex);
  return state_->text[1];
}

void ChildProcess::Signal(int signal) { kill(state_->pid, signal); }

void ChildProcess::Kill() {
  Signal(SIGKILL);
  WaitForExit();
}

std::optional<int> ChildProcess::WaitForExit(std::chrono::milliseconds patience) {
  const Clock::time_point deadline = Clock::now() + patience;
  MutexLock lock(state_->mutex);
  while (!state_->Ended()) {
    if (Clock::now() >= deadline) return std::nullopt;
    // The end of a process wakes no condition variable: look again every few milliseconds.
    state_->changed.WaitFor(state_->mutex, std::chrono::milliseconds(5));
  }
  // Its last words may still be on their way; a process that it left behind may hold them open.
  const Clock::time_point words = Clock::now() + std::chrono::seconds(2);
  while (!state_->drained && Clock::now() < words) {
    state_->changed.WaitFor(state_->mutex, Until(words));
  }
  return state_->exit_code;
}

Result<FinishedProcess> RunProcess(const std::vector<std::string>& command,
                                   const ProcessOptions& options,
                                   std::chrono::milliseconds patience) {
  VS_ASSIGN_OR_RETURN(const std::unique_ptr<ChildProcess> process,
                      ChildProcess::Start(command, options));
  const std::optional<int> exit_code = process->WaitForExit(patience);
  if (!exit_code) {
    return DeadlineExceeded(Str(command[0], " still runs after ", patience.count(),
                                " ms; it wrote: ", process->Output(), process->ErrorOutput()));
  }
  return FinishedProcess{*exit_code, process->Output(), process->ErrorOutput()};
}

}  // namespace vs::test
