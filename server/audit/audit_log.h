#pragma once

#include <cstdint>
#include <deque>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <thread>

#include "engine/base/clock.h"
#include "engine/base/mutex.h"
#include "engine/base/status.h"
#include "server/audit/audit_store.h"
#include "server/rpc/auditor.h"

namespace vs {

struct AuditOptions {
  std::filesystem::path file;  // made when there is none
  AuditLimits limits;
  // Whether there is such a user. Of a failed login only the name of a real one is kept: another
  // may be a password in the wrong field.
  std::function<bool(const std::string& name)> is_user;
  // Told on the log's own thread whenever writing fails, and with OK when it works again.
  std::function<void(const Status&)> on_state;
};

// Keeps an entry for each call that changes something, good or bad, and for each login. No call
// waits for the disk: a thread writes what has come, some milliseconds later. While that fails,
// entries wait in memory; beyond kMaxWaiting they are counted, and the count becomes an entry.
// Thread-safe.
class AuditLog final : public Auditor {
 public:
  static constexpr size_t kMaxWaiting = 4096;  // half of it for strangers

  // `clock` must outlive it.
  static Result<std::unique_ptr<AuditLog>> Open(AuditOptions options, const Clock& clock);
  // Writes what waits, once.
  ~AuditLog() override;

  bool Records(const std::string& method) const override;
  void Record(const Call& call, const Status& outcome) override VS_EXCLUDES(mutex_);

  AuditStore& store() { return *store_; }

 private:
  AuditLog(AuditOptions options, std::unique_ptr<AuditStore> store, const Clock& clock);
  void Run() VS_EXCLUDES(mutex_);
  // True: all that waited is written.
  bool WriteWaiting() VS_EXCLUDES(mutex_);
  void Trim();
  void Tell(const Status& status);

  const AuditOptions options_;
  const std::unique_ptr<AuditStore> store_;
  const Clock& clock_;
  Mutex mutex_;
  CondVar changed_;
  bool closing_ VS_GUARDED_BY(mutex_) = false;
  std::deque<AuditEntry> waiting_ VS_GUARDED_BY(mutex_);
  uint64_t lost_ VS_GUARDED_BY(mutex_) = 0;
  // Of the writing thread.
  bool failing_ = false;
  size_t written_ = 0;   // since the last Trim
  std::jthread thread_;  // last: everything it uses exists before it starts
};

}  // namespace vs
