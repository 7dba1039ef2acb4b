#pragma once

#include <string>
#include <string_view>
#include <vector>

#include <tl/expected.hpp>

namespace vs::client {

// Why a call failed. The numbers are gRPC's.
enum class Code {
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

// "NOT_FOUND" and the like.
std::string_view CodeName(Code code);

// One fault among several: what it is about ("block.parameter", a field) and what is wrong with it.
struct Fault {
  std::string subject;
  std::string message;

  bool operator==(const Fault&) const = default;
};

// What every call of this library answers when it fails. A lost connection is kUnavailable, a call
// without an answer in time kDeadlineExceeded; all else comes from the server.
struct Error {
  Code code = Code::kUnknown;
  // For people: what was expected, what was found, what to do.
  std::string message;
  // A stable word for programs, such as "PASSWORD_CHANGE_REQUIRED" or "CERTIFICATE_MISMATCH"; the
  // name of the code when there is nothing more precise.
  std::string reason;
  // All faults that were found at once; empty for a single error.
  std::vector<Fault> faults;

  // "NOT_FOUND: message" and one indented line for each fault.
  std::string ToString() const;
};

// A value, or the error that says why there is none: `if (!result) ... result.error()`, `*result`.
template <class T>
using Result = tl::expected<T, Error>;

// Lets a function that returns a Result say `return Failure(Code::kNotFound, "...")`.
tl::unexpected<Error> Failure(Code code, std::string message, std::string_view reason = {});

}  // namespace vs::client
