#pragma once

#include <condition_variable>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <string>

#include "client/connection.h"

namespace vs::client {

// Gives a server credit for the items of one subscription, without waiting for its answers: one
// call at a time is under way, and the next one stands for all that came meanwhile. Thread-safe.
class Acknowledger {
 public:
  explicit Acknowledger(std::shared_ptr<Connection> connection);
  // Waits for the call under way.
  ~Acknowledger();
  Acknowledger(const Acknowledger&) = delete;
  Acknowledger& operator=(const Acknowledger&) = delete;

  // A stream was opened: what was not acknowledged yet belonged to the one before.
  void Begin(std::string stream_id);
  // An item of the stream was dealt with, and with it all before it.
  void Acknowledge(uint32_t subscription_id, uint64_t seq);

 private:
  struct Call;
  // With mutex_ held.
  void Send(uint32_t subscription_id, uint64_t seq);
  void Answered();

  const std::shared_ptr<Connection> connection_;
  std::mutex mutex_;
  std::condition_variable idle_;
  std::string stream_id_;
  uint32_t subscription_id_ = 0;
  std::optional<uint64_t> waiting_;  // to be sent after the call under way
  std::unique_ptr<Call> call_;       // the call under way
};

}  // namespace vs::client
