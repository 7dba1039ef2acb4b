#pragma once

#include <sys/types.h>

#include <chrono>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "engine/base/status.h"

namespace vs::test {

// How long a test waits for something that must happen. Only a broken program ever waits so long;
// it is generous because the machine may be busy with other work.
inline constexpr std::chrono::seconds kPatience{60};

struct ProcessOptions {
  std::map<std::string, std::string> environment;  // added to the test's own
  std::string input;                               // what the program reads from standard input
  std::string directory;                           // where it starts; empty = here
};

// A program that a test started, in a process group of its own. Everything it writes is collected,
// so it never blocks on a full pipe. When the object goes, the program and what it started are
// killed, by their saved id; they die too when the thread that started them dies, so start it from
// a thread that lives as long as the test. Calls are thread-safe.
class ChildProcess {
 public:
  // `command` is the program (looked up in PATH if it has no slash) and its arguments. Errors:
  // NOT_FOUND or PERMISSION_DENIED with the program's name if it cannot be run.
  static Result<std::unique_ptr<ChildProcess>> Start(const std::vector<std::string>& command,
                                                     const ProcessOptions& options = {});
  ~ChildProcess();
  ChildProcess(const ChildProcess&) = delete;
  ChildProcess& operator=(const ChildProcess&) = delete;

  pid_t Pid() const;

  // The first line of standard output or standard error that contains `text`, once it has come;
  // nothing if the program ends or `patience` passes without one.
  std::optional<std::string> WaitForLine(std::string_view text,
                                         std::chrono::milliseconds patience = kPatience);
  // All that came so far.
  std::string Output() const;
  std::string ErrorOutput() const;

  // To the process alone, not to what it started. Does nothing once it has ended.
  void Signal(int signal);
  // SIGKILL, and wait until it is gone.
  void Kill();
  // The exit code, or 128 + signal, once it has ended and its output is collected; nothing if it
  // still runs after `patience`.
  std::optional<int> WaitForExit(std::chrono::milliseconds patience = kPatience);

 private:
  struct State;
  explicit ChildProcess(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

// What a program did that has ended.
struct FinishedProcess {
  int exit_code = -1;  // 128 + signal if a signal ended it
  std::string output;
  std::string error_output;
};

// Runs a program to its end. DEADLINE_EXCEEDED (and the program is killed) after `patience`.
Result<FinishedProcess> RunProcess(const std::vector<std::string>& command,
                                   const ProcessOptions& options = {},
                                   std::chrono::milliseconds patience = kPatience);

}  // namespace vs::test
