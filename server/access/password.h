#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "engine/base/status.h"

namespace vs {

// Of argon2id. The default is libsodium's "interactive": 64 MiB and a fifth of a second for each
// guess. Only tests take less.
struct PasswordCost {
  uint64_t passes = 2;
  size_t memory_bytes = size_t{64} << 20;
};

// Hashes passwords with argon2id. Thread-safe, but each call takes the memory and time above: the
// caller sees to it that few run at once.
class PasswordHasher {
 public:
  explicit PasswordHasher(PasswordCost cost = {});

  // RESOURCE_EXHAUSTED when there is no memory for it.
  Result<std::string> Hash(std::string_view password) const;
  // An empty or damaged hash fits no password, in the same time as any other wrong one.
  bool Verify(const std::string& hash, std::string_view password) const;
  // True: made with less than today's cost.
  bool Outdated(const std::string& hash) const;

  // Calls of Hash and Verify so far; each one has cost the same.
  uint64_t Computed() const { return computed_; }

 private:
  PasswordCost cost_;
  std::string decoy_;  // hash of a password that nobody knows
  mutable std::atomic<uint64_t> computed_{0};
};

// INVALID_ARGUMENT naming the rule that a new password breaks: 10 characters to 1024 bytes, not the
// user's name, not among the common ones.
Status CheckNewPassword(std::string_view user, std::string_view password);

}  // namespace vs
