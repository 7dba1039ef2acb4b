#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>

#include "visionserver/v1/result.pb.h"

#include "client/error.h"

namespace vs::client {

class Connection;

// Every new result, in the order of storing, none left out: after a lost connection it goes on
// where it was, and with the first result of a server that has begun its results anew. A thread of
// its own receives; when nobody takes, it stops receiving and the server keeps the results. One
// thread at a time may call Next.
class ResultStream {
 public:
  // Only what `filter` lets through. `after_number`: first those stored after this Result.number;
  // absent: new ones only.
  ResultStream(std::shared_ptr<Connection> connection, visionserver::v1::ResultFilter filter,
               std::optional<uint64_t> after_number);
  ~ResultStream();
  ResultStream(ResultStream&&) noexcept;
  ResultStream& operator=(ResultStream&&) noexcept;

  // The next result; waits for it. DEADLINE_EXCEEDED when none came: call again. Errors that
  // waiting does not mend come at once, every time.
  Result<visionserver::v1::Result> Next(std::chrono::milliseconds timeout);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace vs::client
