#include "server/http/tls_context.h"

#include <openssl/ssl.h>

#include "engine/base/log.h"
#include "engine/base/str.h"

namespace vs {
namespace {

constexpr int64_t kLookNs = 1'000'000'000;

}  // namespace

Result<std::unique_ptr<TlsContext>> TlsContext::Load(const CertificateFiles& files) {
  std::unique_ptr<TlsContext> loaded(new TlsContext(files));
  VS_RETURN_IF_ERROR(loaded->Reload());
  return loaded;
}

std::shared_ptr<ssl_ctx_st> TlsContext::Current() {
  if (clock_.MonotonicNs() - looked_ns_ < kLookNs || ChangeTimes() == seen_) return context_;
  // While its two files are being replaced they do not match: then the old one is used on.
  if (const Status reloaded = Reload(); !reloaded.ok()) {
    LogWarn("http", Str("the certificate is not changed: ", reloaded.message()));
  }
  return context_;
}

Status TlsContext::Reload() {
  looked_ns_ = clock_.MonotonicNs();
  seen_ = ChangeTimes();
  const std::shared_ptr<ssl_ctx_st> context(SSL_CTX_new(TLS_server_method()), SSL_CTX_free);
  if (!context) return Internal("OpenSSL cannot start");
  SSL_CTX* raw = context.get();
  SSL_CTX_set_min_proto_version(raw, TLS1_2_VERSION);
  SSL_CTX_set_options(raw, SSL_OP_NO_RENEGOTIATION | SSL_OP_NO_COMPRESSION);
  SSL_CTX_set_session_cache_mode(raw, SSL_SESS_CACHE_OFF);
  SSL_CTX_set_mode(raw, SSL_MODE_RELEASE_BUFFERS);
  if (SSL_CTX_use_certificate_chain_file(raw, files_.certificate.c_str()) != 1 ||
      SSL_CTX_use_PrivateKey_file(raw, files_.key.c_str(), SSL_FILETYPE_PEM) != 1 ||
      SSL_CTX_check_private_key(raw) != 1) {
    return FailedPrecondition(Str("cannot use ", files_.certificate.string(), " with the key ",
                                  files_.key.string(), ": they must be PEM and belong together"));
  }
  context_ = context;
  return Status();
}

TlsContext::Times TlsContext::ChangeTimes() const {
  std::error_code ignored;
  return {std::filesystem::last_write_time(files_.certificate, ignored),
          std::filesystem::last_write_time(files_.key, ignored)};
}

}  // namespace vs
