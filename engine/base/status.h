#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <tl/expected.hpp>

namespace vs {

// Why a call failed. The numbers are those of gRPC, so that an error crosses the network unchanged.
enum class StatusCode {
  kOk = 0,
  kCancelled = 1,
  kUnknown = 2,
  kInvalidArgument = 3,
  kDeadlineExceeded = 4,
  kNotFound = 5,
  kAlreadyExists = 6,
  kPermissionDenied = 7,
  kResourceExhausted = 8,
  kFailedPrecondition = 9,
  kAborted = 10,
  kOutOfRange = 11,
  kUnimplemented = 12,
  kInternal = 13,
  kUnavailable = 14,
  kDataLoss = 15,
  kUnauthenticated = 16,
};

// "INVALID_ARGUMENT" and the like.
std::string_view StatusCodeName(StatusCode code);

// One fault among several: what it is about (a block id, "block.parameter", a file) and what is
// wrong with it.
struct Fault {
  std::string subject;
  std::string message;

  bool operator==(const Fault&) const = default;
};

// The outcome of a call that can fail in expected ways.
//
// A message says what was expected, what was found and what to do. It never carries secrets. An
// error is handled once: passed up, perhaps with `Annotated` context, or logged; never both.
class [[nodiscard]] Status {
 public:
  Status() = default;
  Status(StatusCode code, std::string message, std::vector<Fault> faults = {})
      : code_(code), message_(std::move(message)), faults_(std::move(faults)) {}

  bool ok() const { return code_ == StatusCode::kOk; }
  StatusCode code() const { return code_; }
  const std::string& message() const { return message_; }
  // All faults that were found at once; empty for a single error.
  const std::vector<Fault>& faults() const { return faults_; }
  // A stable upper-case word that a program can act on, such as "PASSWORD_CHANGE_REQUIRED": the
  // name of the code unless WithReason gave a more precise one.
  std::string_view reason() const;

  Status WithReason(std::string_view reason) const;
  // The same status with "context: " put before its message.
  Status Annotated(std::string_view context) const;
  // "INVALID_ARGUMENT: message" and one indented line for each fault.
  std::string ToString() const;

  // Lets a function that returns Result<T> say `return InvalidArgument("...")`.
  template <class T>
  operator tl::expected<T, Status>() const {  // NOLINT(google-explicit-constructor)
    return tl::unexpected<Status>(*this);
  }

  bool operator==(const Status&) const = default;

 private:
  StatusCode code_ = StatusCode::kOk;
  std::string message_;
  std::vector<Fault> faults_;
  std::string reason_;
};

// A value, or the Status that says why there is none.
template <class T>
using Result = tl::expected<T, Status>;

Status InvalidArgument(std::string message);
Status NotFound(std::string message);
Status AlreadyExists(std::string message);
Status PermissionDenied(std::string message);
Status Unauthenticated(std::string message);
Status ResourceExhausted(std::string message);
Status FailedPrecondition(std::string message);
Status Aborted(std::string message);
Status OutOfRange(std::string message);
Status Unimplemented(std::string message);
Status Internal(std::string message);
Status Unavailable(std::string message);
Status DeadlineExceeded(std::string message);
Status DataLoss(std::string message);
Status Cancelled(std::string message);

}  // namespace vs

// Leaves the function with the error of `expression` (a Status), if it has one.
#define VS_RETURN_IF_ERROR(expression)                              \
  do {                                                              \
    if (::vs::Status vs_status_ = (expression); !vs_status_.ok()) { \
      return vs_status_;                                            \
    }                                                               \
  } while (false)

#define VS_CONCAT_INNER_(a, b) a##b
#define VS_CONCAT_(a, b) VS_CONCAT_INNER_(a, b)

// VS_ASSIGN_OR_RETURN(auto rig, LoadRig(path)): the value, or out with the error.
#define VS_ASSIGN_OR_RETURN(target, expression) \
  VS_ASSIGN_OR_RETURN_(VS_CONCAT_(vs_result_, __LINE__), target, expression)
// NOLINTBEGIN(bugprone-macro-parentheses): a declaration cannot stand in parentheses.
#define VS_ASSIGN_OR_RETURN_(result, target, expression) \
  auto result = (expression);                            \
  if (!(result).has_value()) {                           \
    return (result).error();                             \
  }                                                      \
  target = std::move(*result)
// NOLINTEND(bugprone-macro-parentheses)
