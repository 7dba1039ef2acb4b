#pragma once

#include <string>
#include <vector>

#include "tests/support/child_process.h"
#include "tests/support/temp_folder.h"

namespace vs::test {

// Runs the real visionctl, with a home of its own so that logins stay among the test's.
class Visionctl {
 public:
  // Its options for the server of the test, put behind every command.
  explicit Visionctl(std::vector<std::string> server_options = {});

  FinishedProcess operator()(const std::vector<std::string>& arguments,
                             const std::string& input = "") const;
  // A line as it is typed: the shell finds visionctl, and the files in home().
  FinishedProcess Shell(const std::string& line) const;
  // The lines that the help of a command gives as examples; `words` is "login", "cameras set" ...
  std::vector<std::string> Examples(const std::string& words) const;
  // Starts it and lets it run.
  std::unique_ptr<ChildProcess> Start(const std::vector<std::string>& arguments) const;

  // More for its environment.
  std::map<std::string, std::string>& environment() { return environment_; }
  const TempFolder& home() const { return home_; }

 private:
  std::vector<std::string> CommandLine(const std::vector<std::string>& arguments) const;

  const std::vector<std::string> server_options_;
  TempFolder home_;
  std::map<std::string, std::string> environment_;
};

}  // namespace vs::test
