#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "client/error.h"

namespace google::protobuf {
class Message;
class Timestamp;
}  // namespace google::protobuf

namespace vs::cli {

// Aligned columns with a heading, as wide as what stands in them.
class Table {
 public:
  // A name that begins with '>' has its column flush right, for numbers.
  explicit Table(const std::vector<std::string>& names);

  // One cell for each column.
  void Add(std::vector<std::string> cells);
  // To standard output. `empty` is said instead when there is no row.
  void Print(std::string_view empty) const;

 private:
  std::vector<bool> right_;
  std::vector<std::vector<std::string>> rows_;  // the first is the heading
};

// The text with everything that would move the cursor or change the terminal replaced by '?': what
// a camera or another user calls itself must not do so.
std::string Printable(std::string_view text);

// One line to standard output.
void PrintLine(const std::string& text);
// The message as JSON to standard output, indented or on one line.
void PrintJson(const google::protobuf::Message& message, bool indented = true);
// Several messages as one JSON object.
void PrintJsonObject(
    const std::vector<std::pair<std::string, const google::protobuf::Message*>>& members);
// One line to standard error, and one for each fault that it does not tell; or one line of JSON.
void PrintError(const client::Error& error, bool json);

// "2026-01-31 14:03:59.123" in local time; "-" for none.
std::string TimeText(const google::protobuf::Timestamp& time);
// With so many digits after the point.
std::string NumberText(double number, int digits);

}  // namespace vs::cli
