#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <utility>

#include "engine/base/clock.h"
#include "engine/base/status.h"
#include "server/transport/certificate.h"

struct ssl_ctx_st;

namespace vs {

// What the server shows and demands in TLS: its certificate, TLS 1.2 or 1.3. Used by one thread.
class TlsContext {
 public:
  // FAILED_PRECONDITION names the files that OpenSSL does not take.
  static Result<std::unique_ptr<TlsContext>> Load(const CertificateFiles& files);

  // For the next connection: looks at the files at most once a second, and takes a changed
  // certificate when it is whole.
  std::shared_ptr<ssl_ctx_st> Current();

 private:
  using Times = std::pair<std::filesystem::file_time_type, std::filesystem::file_time_type>;

  explicit TlsContext(const CertificateFiles& files) : files_(files) {}
  Times ChangeTimes() const;
  Status Reload();

  const CertificateFiles files_;
  const SystemClock clock_;
  std::shared_ptr<ssl_ctx_st> context_;
  std::optional<Times> seen_;  // of the files when they were last read
  int64_t looked_ns_ = 0;
};

}  // namespace vs
