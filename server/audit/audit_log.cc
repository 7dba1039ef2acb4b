#include "server/audit/audit_log.h"

#include <chrono>
#include <utility>
#include <vector>

#include "engine/base/log.h"
#include "engine/base/str.h"
#include "server/access/policy.h"
#include "server/rpc/error_details.h"

namespace vs {
namespace {

constexpr size_t kMaxTextBytes = 512;
constexpr size_t kBatch = 256;
constexpr size_t kTrimAfter = 1000;
constexpr std::chrono::seconds kRetry{1};
constexpr std::chrono::hours kTrimPeriod{1};

}  // namespace

Result<std::unique_ptr<AuditLog>> AuditLog::Open(AuditOptions options, const Clock& clock) {
  VS_ASSIGN_OR_RETURN(std::unique_ptr<AuditStore> store, AuditStore::Open(options.file));
  return std::unique_ptr<AuditLog>(new AuditLog(std::move(options), std::move(store), clock));
}

AuditLog::AuditLog(AuditOptions options, std::unique_ptr<AuditStore> store, const Clock& clock)
    : options_(std::move(options)), store_(std::move(store)), clock_(clock) {
  thread_ = std::jthread([this] { Run(); });
}

AuditLog::~AuditLog() {
  {
    MutexLock lock(mutex_);
    closing_ = true;
  }
  changed_.NotifyAll();
  thread_.join();
}

bool AuditLog::Records(const std::string& method) const {
  const AccessRule* rule = FindAccessRule(method);
  return rule != nullptr && rule->changes;
}

void AuditLog::Record(const Call& call, const Status& outcome) {
  AuditEntry entry{.time_utc_ns = clock_.UtcNs(),
                   .user = call.caller.name,
                   .address = call.address,
                   .method = call.method,
                   .subject = CutTo(call.subject, kMaxTextBytes),
                   .ok = outcome.ok(),
                   .message = CutTo(outcome.message(), kMaxTextBytes)};
  // A login: about nobody else but who it is.
  if (const AccessRule* rule = FindAccessRule(call.method);
      rule != nullptr && rule->without_login) {
    entry.user = options_.is_user(call.subject) ? call.subject : "";
    entry.subject.clear();
  }
  entry.by_stranger = !entry.ok && call.caller.kind == Caller::Kind::kNobody;
  {
    MutexLock lock(mutex_);
    if (waiting_.size() >= (entry.by_stranger ? kMaxWaiting / 2 : kMaxWaiting)) {
      ++lost_;
      return;
    }
    waiting_.push_back(std::move(entry));
  }
  changed_.NotifyAll();
}

void AuditLog::Run() {
  Trim();
  while (true) {
    const bool done = WriteWaiting();
    MutexLock lock(mutex_);
    if (closing_ && (waiting_.empty() || !done)) return;
    if (!done) {
      changed_.WaitFor(mutex_, kRetry);
      continue;
    }
    if (waiting_.empty() && !closing_ && !changed_.WaitFor(mutex_, kTrimPeriod)) {
      written_ = kTrimAfter;
    }
  }
}

bool AuditLog::WriteWaiting() {
  std::vector<AuditEntry> batch;
  uint64_t lost = 0;
  {
    MutexLock lock(mutex_);
    for (size_t i = 0; i < waiting_.size() && i < kBatch; ++i) batch.push_back(waiting_[i]);
    lost = lost_;
  }
  const size_t taken = batch.size();
  if (lost > 0) {
    batch.push_back({.time_utc_ns = clock_.UtcNs(),
                     .message = Str(lost,
                                    " entries are missing here: the server could not write "
                                    "them as fast as they came")});
  }
  if (!batch.empty()) {
    const Status written = store_->Append(batch);
    Tell(written);
    if (!written.ok()) return false;
    written_ += batch.size();
  }
  {
    MutexLock lock(mutex_);
    waiting_.erase(waiting_.begin(), waiting_.begin() + static_cast<std::ptrdiff_t>(taken));
    lost_ -= lost;
  }
  if (written_ >= kTrimAfter) Trim();
  return true;
}

void AuditLog::Trim() {
  written_ = 0;
  const Status trimmed = store_->Trim(options_.limits, clock_.UtcNs());
  if (!trimmed.ok()) {
    LogWarn("audit", Str("old entries of the audit log are not removed: ", trimmed.message()));
  }
}

void AuditLog::Tell(const Status& status) {
  if (status.ok() && !failing_) return;
  failing_ = !status.ok();
  options_.on_state(status);
}

}  // namespace vs
