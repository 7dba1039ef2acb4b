#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "client/error.h"

namespace vs::cli {

class Session;

// What visionctl ends with. Scripts rely on these numbers.
enum ExitCode {
  kExitOk = 0,
  kExitFailure = 1,        // something else, such as a file that cannot be written
  kExitUsage = 2,          // the command line makes no sense
  kExitCannotConnect = 3,  // no server, not this server, or the connection is lost
  kExitNotAllowed = 4,     // not logged in, or the role does not permit it
  kExitNotFound = 5,       // no such sequence, camera, parameter, user ...
  kExitInvalid = 6,        // a value, sequence or query that the server refuses
  kExitTimeout = 7,        // nothing came in time
  kExitConflict = 8,       // the state of things does not allow it, or somebody was quicker
};

ExitCode ExitCodeOf(client::Code code);

// Where the value of an argument will be once the command runs.
template <class T>
using Argument = std::shared_ptr<T>;

// One command of visionctl. Declares its arguments, then what it does.
class Command {
 public:
  virtual ~Command() = default;

  // In their order on the command line.
  virtual Argument<std::string> Positional(const std::string& name, const std::string& doc) = 0;
  // Empty when it is not given.
  virtual Argument<std::string> OptionalPositional(const std::string& name,
                                                   const std::string& doc) = 0;
  // One or more; with `optional` none will do.
  virtual Argument<std::vector<std::string>> Positionals(const std::string& name,
                                                         const std::string& doc,
                                                         bool optional = false) = 0;
  // `flag` is "--name", `value` names what follows it in the help.
  virtual Argument<std::string> Text(const std::string& flag, const std::string& value,
                                     const std::string& doc, const std::string& initial = "") = 0;
  virtual Argument<int64_t> Count(const std::string& flag, const std::string& doc, int64_t initial,
                                  int64_t min, int64_t max) = 0;
  // Nothing when it is not given.
  virtual Argument<std::optional<int64_t>> OptionalCount(const std::string& flag,
                                                         const std::string& doc, int64_t min,
                                                         int64_t max) = 0;
  virtual Argument<double> Number(const std::string& flag, const std::string& doc, double initial,
                                  double min, double max) = 0;
  virtual Argument<bool> Flag(const std::string& flag, const std::string& doc) = 0;
  // One of these words only.
  virtual Argument<std::string> Choice(const std::string& flag, const std::string& doc,
                                       const std::vector<std::string>& choices,
                                       const std::string& initial) = 0;
  // May be repeated.
  virtual Argument<std::vector<std::string>> Texts(const std::string& flag,
                                                   const std::string& value,
                                                   const std::string& doc) = 0;

  // Shown by --help.
  virtual Command& Example(const std::string& line) = 0;
  virtual void Run(std::function<client::Result<void>(Session&)> run) = 0;
};

// The commands of visionctl and its common options.
class CommandLine {
 public:
  CommandLine();
  ~CommandLine();
  CommandLine(const CommandLine&) = delete;
  CommandLine& operator=(const CommandLine&) = delete;

  // A heading for several commands: "cameras", then "cameras list" and so on.
  void AddGroup(const std::string& name, const std::string& doc);
  // `path` is "login" or "cameras list". Belongs to the command line.
  Command& Add(const std::string& path, const std::string& doc);

  // Understands the arguments and runs what they say. Errors go to standard error.
  int Main(int argument_count, const char* const* arguments);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

// Each file of commands adds its own.
void AddSessionCommands(CommandLine& line);
void AddCameraCommands(CommandLine& line);
void AddSequenceCommands(CommandLine& line);
void AddParameterCommands(CommandLine& line);
void AddStreamCommands(CommandLine& line);
void AddDepthCommand(CommandLine& line);
void AddResultCommands(CommandLine& line);
void AddUserCommands(CommandLine& line);
void AddKeyCommands(CommandLine& line);
void AddAuditCommand(CommandLine& line);
void AddStatusCommand(CommandLine& line);

}  // namespace vs::cli
