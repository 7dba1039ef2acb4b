#include "client/certificate.h"

#include <arpa/inet.h>
#include <openssl/err.h>
#include <openssl/pem.h>
#include <openssl/ssl.h>
#include <openssl/x509v3.h>
#include <poll.h>

#include <array>
#include <cctype>
#include <cstdio>
#include <fstream>
#include <memory>
#include <sstream>

#include "client/socket.h"

namespace vs::client {
namespace {

// Debian's bundle of the authorities that the system trusts.
constexpr const char* kSystemRoots = "/etc/ssl/certs/ca-certificates.crt";

template <auto Free>
struct Freeing {
  template <class T>
  void operator()(T* object) const {
    Free(object);
  }
};
using Bio = std::unique_ptr<BIO, Freeing<BIO_free_all>>;
using Certificate = std::unique_ptr<X509, Freeing<X509_free>>;
using Context = std::unique_ptr<SSL_CTX, Freeing<SSL_CTX_free>>;
using Ssl = std::unique_ptr<SSL, Freeing<SSL_free>>;
using Names = std::unique_ptr<GENERAL_NAMES, Freeing<GENERAL_NAMES_free>>;

bool IsIpAddress(const std::string& host) {
  in6_addr parsed{};
  return inet_pton(AF_INET, host.c_str(), &parsed) == 1 ||
         inet_pton(AF_INET6, host.c_str(), &parsed) == 1;
}

int AddRoots(SSL_CTX* context, const std::string& pem) {
  const Bio bio(BIO_new_mem_buf(pem.data(), static_cast<int>(pem.size())));
  X509_STORE* store = SSL_CTX_get_cert_store(context);
  int count = 0;
  while (const auto one = Certificate(PEM_read_bio_X509(bio.get(), nullptr, nullptr, nullptr))) {
    count += X509_STORE_add_cert(store, one.get());
  }
  ERR_clear_error();  // the end of the text counts as one
  return count;
}

// A TLS client that looks at any certificate, and remembers what is wrong with it.
Ssl NewClient(SSL_CTX* context, const Address& address) {
  static constexpr std::array<unsigned char, 3> kHttp2 = {2, 'h', '2'};
  Ssl ssl(SSL_new(context));
  SSL_set_verify(ssl.get(), SSL_VERIFY_NONE, nullptr);
  SSL_set_alpn_protos(ssl.get(), kHttp2.data(), kHttp2.size());
  if (IsIpAddress(address.host)) {
    X509_VERIFY_PARAM_set1_ip_asc(SSL_get0_param(ssl.get()), address.host.c_str());
  } else {
    SSL_set_tlsext_host_name(ssl.get(), address.host.c_str());
    SSL_set1_host(ssl.get(), address.host.c_str());
  }
  return ssl;
}

Result<void> Handshake(SSL* ssl, const Address& address, int fd, Deadline deadline) {
  SSL_set_fd(ssl, fd);
  for (;;) {
    const int done = SSL_connect(ssl);
    if (done == 1) return {};
    const int wants = SSL_get_error(ssl, done);
    ERR_clear_error();
    if (wants != SSL_ERROR_WANT_READ && wants != SSL_ERROR_WANT_WRITE) {
      return Failure(Code::kUnavailable,
                     address.ToString() +
                         " does not speak TLS: is this the server's port? (A server that was "
                         "started without TLS is reached as plain text, from its own machine only)",
                     "NO_TLS");
    }
    if (!WaitFor(fd, wants == SSL_ERROR_WANT_READ ? POLLIN : POLLOUT, deadline)) {
      return Failure(
          Code::kUnavailable,
          address.ToString() + " accepts connections but does not answer as a TLS server",
          "CONNECTION_TIMEOUT");
    }
  }
}

std::string Fingerprint(X509* certificate) {
  std::array<unsigned char, EVP_MAX_MD_SIZE> digest{};
  unsigned int size = 0;
  X509_digest(certificate, EVP_sha256(), digest.data(), &size);
  std::string text;
  for (unsigned int i = 0; i < size; ++i) {
    std::array<char, 4> hex{};
    std::snprintf(hex.data(), hex.size(), i == 0 ? "%02X" : ":%02X", digest[i]);
    text += hex.data();
  }
  return text;
}

std::string Pem(X509* certificate) {
  const Bio bio(BIO_new(BIO_s_mem()));
  PEM_write_bio_X509(bio.get(), certificate);
  char* text = nullptr;
  const long size = BIO_get_mem_data(bio.get(), &text);
  return {text, static_cast<size_t>(size)};
}

std::string Text(const ASN1_STRING* string) {
  return {reinterpret_cast<const char*>(ASN1_STRING_get0_data(string)),
          static_cast<size_t>(ASN1_STRING_length(string))};
}

std::string IpText(const ASN1_OCTET_STRING* address) {
  std::array<char, INET6_ADDRSTRLEN> text{};
  const int family = ASN1_STRING_length(address) == 4 ? AF_INET : AF_INET6;
  if (family == AF_INET6 && ASN1_STRING_length(address) != 16) return {};
  inet_ntop(family, ASN1_STRING_get0_data(address), text.data(), text.size());
  return text.data();
}

std::vector<std::string> NamesOf(X509* certificate) {
  std::vector<std::string> hosts;
  std::vector<std::string> addresses;
  const Names names(static_cast<GENERAL_NAMES*>(
      X509_get_ext_d2i(certificate, NID_subject_alt_name, nullptr, nullptr)));
  for (int i = 0; names && i < sk_GENERAL_NAME_num(names.get()); ++i) {
    const GENERAL_NAME* name = sk_GENERAL_NAME_value(names.get(), i);
    if (name->type == GEN_DNS) hosts.push_back(Text(name->d.dNSName));
    if (name->type == GEN_IPADD) addresses.push_back(IpText(name->d.iPAddress));
  }
  hosts.insert(hosts.end(), addresses.begin(), addresses.end());
  return hosts;
}

std::string Distrust(const SSL* ssl, const ServerCertificate& certificate, const Address& address) {
  const long verdict = SSL_get_verify_result(ssl);
  if (verdict == X509_V_OK) return {};
  if (verdict == X509_V_ERR_HOSTNAME_MISMATCH || verdict == X509_V_ERR_IP_ADDRESS_MISMATCH) {
    std::string names;
    for (const std::string& name : certificate.names) names += (names.empty() ? "" : ", ") + name;
    return "it is for " + names + ", not for " + address.host;
  }
  return X509_verify_cert_error_string(verdict);
}

}  // namespace

Result<ServerCertificate> FetchCertificate(const Address& address, const std::string& roots_pem,
                                           std::chrono::milliseconds timeout) {
  const Deadline deadline = std::chrono::steady_clock::now() + timeout;
  Result<Socket> socket = ConnectTcp(address, deadline);
  if (!socket) return tl::unexpected(socket.error());
  const Context context(SSL_CTX_new(TLS_client_method()));
  AddRoots(context.get(), roots_pem);
  const Ssl ssl = NewClient(context.get(), address);
  if (const Result<void> done = Handshake(ssl.get(), address, socket->fd(), deadline); !done) {
    return tl::unexpected(done.error());
  }
  X509* shown = SSL_get0_peer_certificate(ssl.get());
  if (shown == nullptr) {
    return Failure(Code::kUnavailable, address.ToString() + " shows no certificate", "NO_TLS");
  }
  ServerCertificate certificate{.pem = Pem(shown),
                                .fingerprint = Fingerprint(shown),
                                .names = NamesOf(shown),
                                .distrust = {}};
  certificate.distrust = Distrust(ssl.get(), certificate, address);
  return certificate;
}

Result<std::string> NormalizeFingerprint(std::string_view text) {
  std::string normal;
  int digits = 0;
  for (const char c : text) {
    if (c == ':') continue;
    if (std::isxdigit(static_cast<unsigned char>(c)) == 0) {
      digits = -1;
      break;
    }
    if (digits > 0 && digits % 2 == 0) normal += ':';
    normal += static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
    ++digits;
  }
  if (digits == 64) return normal;
  return Failure(Code::kInvalidArgument,
                 "\"" + std::string(text) +
                     "\" is no SHA-256 fingerprint: give the 64 hexadecimal digits that the server "
                     "printed when it started");
}

Result<std::string> ReadRoots(const std::string& ca_file) {
  std::ifstream file(ca_file.empty() ? kSystemRoots : ca_file.c_str(), std::ios::binary);
  std::ostringstream content;
  content << file.rdbuf();
  std::string pem = content.str();
  if (ca_file.empty()) return pem;
  const Context context(SSL_CTX_new(TLS_client_method()));
  if (AddRoots(context.get(), pem) == 0) {
    return Failure(Code::kInvalidArgument,
                   "\"" + ca_file + "\" cannot be read or holds no certificate in PEM form");
  }
  return pem;
}

}  // namespace vs::client
