#include "client/cli/command_line.h"

#include <algorithm>
#include <iostream>
#include <map>
#include <string_view>
#include <type_traits>
#include <utility>

#include <CLI/CLI.hpp>

#include "client/cli/output.h"
#include "client/cli/session.h"

namespace vs::cli {
namespace {

constexpr char kDoc[] =
    "visionctl: log in to a VisionServer, run its sequences, see its depth, read its results.\n"
    "\n"
    "First time:\n"
    "  visionctl login admin --server cell-7 --fingerprint AB:CD:...\n"
    "The server prints its certificate's fingerprint when it starts. visionctl keeps address,\n"
    "fingerprint and token for you only, in ~/.config/visionserver/, so later commands need none.";

constexpr char kFooter[] =
    "Environment: VISIONSERVER_ADDRESS, VISIONSERVER_CA and VISIONSERVER_FINGERPRINT stand for "
    "the\n"
    "options; VISIONSERVER_TOKEN is an API key or token to use instead of the stored login.\n"
    "\n"
    "Trust: a server is known by the file of its certificate or of the authority that signed it\n"
    "(--ca), by the SHA-256 fingerprint of its certificate (--fingerprint), or by an authority "
    "that\n"
    "this system trusts. Compare a fingerprint with the one that the server printed; visionctl\n"
    "never trusts a certificate just because it met it first.\n"
    "\n"
    "Exit codes: 0 done, 1 other failure, 2 wrong usage, 3 cannot connect, 4 not logged in or not\n"
    "permitted, 5 not found, 6 refused as invalid, 7 nothing came in time, 8 the state of things\n"
    "does not allow it.";

constexpr char kCommonFooter[] =
    "Common options (--server, --ca, --fingerprint, --json ...) and exit codes: visionctl --help";

// A number within a range, whose help says no more than `name`.
template <class T>
CLI::Option* Limit(CLI::Option* option, const std::string& name, T min, T max) {
  return option->type_name(name)->check([=](const std::string& text) {
    T number{};
    if (!CLI::detail::lexical_cast(text, number)) {
      return "\"" + text + "\" is no " + (std::is_integral_v<T> ? "whole number" : "number");
    }
    if (number >= min && number <= max) return std::string();
    return text + " is not between " + CLI::detail::to_string(min) + " and " +
           CLI::detail::to_string(max);
  });
}

// The error of a command line that makes no sense. CLI11 itself says of a word that is no command
// only that it misses one.
client::Error UsageError(const CLI::App& app, const CLI::ParseError& error) {
  std::string message = error.what();
  std::string path = "visionctl";
  const CLI::App* deepest = &app;
  while (!deepest->get_subcommands().empty()) {
    deepest = deepest->get_subcommands().front();
    path += " " + deepest->get_name();
  }
  const std::vector<std::string> unknown = app.remaining(/*recurse=*/true);
  if (deepest->get_require_subcommand_min() > 0 && !unknown.empty()) {
    const std::string kind = unknown.front().starts_with('-') ? "option" : "command";
    message = path + " has no " + kind + " \"" + unknown.front() + "\"";
  }
  return {.code = client::Code::kInvalidArgument,
          .message = message + " (" + path + " --help says more)",
          .reason = "USAGE",
          .faults = {}};
}

// Whether it was asked for, on a command line that cannot be understood as a whole.
bool AsksForJson(int argument_count, const char* const* arguments) {
  return std::find(arguments, arguments + argument_count, std::string_view("--json")) !=
         arguments + argument_count;
}

class CommandImpl final : public Command {
 public:
  explicit CommandImpl(CLI::App* app) : app_(app) { app_->footer(kCommonFooter); }

  Argument<std::string> Positional(const std::string& name, const std::string& doc) override {
    auto value = std::make_shared<std::string>();
    app_->add_option(name, *value, doc)->required()->type_name("");
    return value;
  }
  Argument<std::string> OptionalPositional(const std::string& name,
                                           const std::string& doc) override {
    auto value = std::make_shared<std::string>();
    app_->add_option(name, *value, doc)->type_name("");
    return value;
  }
  Argument<std::vector<std::string>> Positionals(const std::string& name, const std::string& doc,
                                                 bool optional) override {
    auto value = std::make_shared<std::vector<std::string>>();
    app_->add_option(name, *value, doc)->required(!optional)->type_name("");
    return value;
  }
  Argument<std::string> Text(const std::string& flag, const std::string& value_name,
                             const std::string& doc, const std::string& initial) override {
    auto value = std::make_shared<std::string>(initial);
    app_->add_option(flag, *value, doc)->type_name(value_name);
    return value;
  }
  Argument<int64_t> Count(const std::string& flag, const std::string& doc, int64_t initial,
                          int64_t min, int64_t max) override {
    auto value = std::make_shared<int64_t>(initial);
    Limit(app_->add_option(flag, *value, doc), "N", min, max)->default_val(initial);
    return value;
  }
  Argument<std::optional<int64_t>> OptionalCount(const std::string& flag, const std::string& doc,
                                                 int64_t min, int64_t max) override {
    auto value = std::make_shared<std::optional<int64_t>>();
    Limit(app_->add_option(flag, *value, doc), "N", min, max);
    return value;
  }
  Argument<double> Number(const std::string& flag, const std::string& doc, double initial,
                          double min, double max) override {
    auto value = std::make_shared<double>(initial);
    Limit(app_->add_option(flag, *value, doc), "NUMBER", min, max)->default_val(initial);
    return value;
  }
  Argument<bool> Flag(const std::string& flag, const std::string& doc) override {
    auto value = std::make_shared<bool>(false);
    app_->add_flag(flag, *value, doc);
    return value;
  }
  Argument<std::string> Choice(const std::string& flag, const std::string& doc,
                               const std::vector<std::string>& choices,
                               const std::string& initial) override {
    auto value = std::make_shared<std::string>(initial);
    std::string names;
    for (const std::string& choice : choices) names += (names.empty() ? "" : "|") + choice;
    CLI::Option* option = app_->add_option(flag, *value, doc)->type_name(names);
    option->check([choices, names](const std::string& text) {
      const bool known = std::find(choices.begin(), choices.end(), text) != choices.end();
      return known ? std::string() : "\"" + text + "\" is none of " + names;
    });
    return value;
  }
  Argument<std::vector<std::string>> Texts(const std::string& flag, const std::string& value_name,
                                           const std::string& doc) override {
    auto value = std::make_shared<std::vector<std::string>>();
    // One value each time, so that the flag may stand before the positional arguments.
    app_->add_option(flag, *value, doc)->type_name(value_name)->expected(1)->take_all();
    return value;
  }

  Command& Example(const std::string& line) override {
    examples_ += (examples_.empty() ? "Examples:\n  " : "\n  ") + line;
    app_->footer(examples_ + "\n\n" + kCommonFooter);
    return *this;
  }

  void Run(std::function<client::Result<void>(Session&)> run) override { run_ = std::move(run); }

  bool chosen() const { return app_->parsed(); }
  client::Result<void> operator()(Session& session) const { return run_(session); }

 private:
  CLI::App* app_;
  std::string examples_;
  std::function<client::Result<void>(Session&)> run_;
};

}  // namespace

ExitCode ExitCodeOf(client::Code code) {
  using client::Code;
  switch (code) {
    case Code::kUnavailable:
      return kExitCannotConnect;
    case Code::kUnauthenticated:
    case Code::kPermissionDenied:
      return kExitNotAllowed;
    case Code::kNotFound:
      return kExitNotFound;
    case Code::kInvalidArgument:
    case Code::kOutOfRange:
      return kExitInvalid;
    case Code::kDeadlineExceeded:
      return kExitTimeout;
    case Code::kFailedPrecondition:
    case Code::kAborted:
    case Code::kAlreadyExists:
      return kExitConflict;
    default:
      return kExitFailure;
  }
}

struct CommandLine::Impl {
  CLI::App app{kDoc, "visionctl"};
  GlobalOptions options;
  std::map<std::string, CLI::App*> groups;
  std::vector<std::unique_ptr<CommandImpl>> commands;
};

CommandLine::CommandLine() : impl_(std::make_unique<Impl>()) {
  CLI::App& app = impl_->app;
  GlobalOptions& options = impl_->options;
  app.fallthrough();
  app.require_subcommand(1);
  app.footer(kFooter);
  app.get_formatter()->column_width(34);
  app.add_option("--server", options.server, "The server (otherwise the one of the last login)")
      ->type_name("HOST[:PORT]");
  app.add_option("--ca", options.ca_file, "Certificate that makes the server known, PEM")
      ->type_name("FILE");
  app.add_option("--fingerprint", options.fingerprint,
                 "SHA-256 fingerprint of the server's certificate")
      ->type_name("AB:CD:...");
  app.add_flag("--plaintext", options.plaintext,
               "Without TLS; only to a server on this machine that was started so");
  app.add_flag("--json", options.json,
               "Print the answer as JSON (64-bit numbers as text, as protobuf does)");
  Limit(app.add_option("--timeout", options.timeout_s, "How long to wait for an answer, seconds"),
        "S", 0.1, 3600.0)
      ->default_val(options.timeout_s);
}

CommandLine::~CommandLine() = default;

void CommandLine::AddGroup(const std::string& name, const std::string& doc) {
  CLI::App* group = impl_->app.add_subcommand(name, doc);
  group->fallthrough();
  group->require_subcommand(1);
  group->footer(kCommonFooter);
  impl_->groups[name] = group;
}

Command& CommandLine::Add(const std::string& path, const std::string& doc) {
  const size_t space = path.find(' ');
  CLI::App* parent =
      space == std::string::npos ? &impl_->app : impl_->groups.at(path.substr(0, space));
  CLI::App* app =
      parent->add_subcommand(space == std::string::npos ? path : path.substr(space + 1), doc);
  app->fallthrough();
  impl_->commands.push_back(std::make_unique<CommandImpl>(app));
  return *impl_->commands.back();
}

int CommandLine::Main(int argument_count, const char* const* arguments) {
  try {
    impl_->app.parse(argument_count, arguments);
  } catch (const CLI::CallForHelp& help) {
    return impl_->app.exit(help);
  } catch (const CLI::ParseError& error) {
    PrintError(UsageError(impl_->app, error), AsksForJson(argument_count, arguments));
    return kExitUsage;
  }
  for (const std::unique_ptr<CommandImpl>& command : impl_->commands) {
    if (!command->chosen()) continue;
    Session session(impl_->options);
    const client::Result<void> done = (*command)(session);
    std::cout.flush();
    if (!done) {
      PrintError(done.error(), impl_->options.json);
      return ExitCodeOf(done.error().code);
    }
    if (!std::cout) {
      std::cerr << "visionctl: cannot write to standard output\n";
      return kExitFailure;
    }
  }
  return kExitOk;
}

}  // namespace vs::cli
