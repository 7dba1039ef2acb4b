#include "server/transport/certificate.h"

#include <arpa/inet.h>
#include <fcntl.h>
#include <ifaddrs.h>
#include <netdb.h>
#include <netinet/in.h>
#include <openssl/evp.h>
#include <openssl/pem.h>
#include <openssl/rand.h>
#include <openssl/x509v3.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <ctime>
#include <memory>

#include "engine/base/str.h"

namespace vs {
namespace {

constexpr long kDayS = 24L * 3600;
constexpr long kLifeS = 3650 * kDayS;

template <auto Free>
struct Freeing {
  template <class T>
  void operator()(T* object) const {
    Free(object);
  }
};
using Key = std::unique_ptr<EVP_PKEY, Freeing<EVP_PKEY_free>>;
using Certificate = std::unique_ptr<X509, Freeing<X509_free>>;
using Extension = std::unique_ptr<X509_EXTENSION, Freeing<X509_EXTENSION_free>>;
using Serial = std::unique_ptr<BIGNUM, Freeing<BN_free>>;
struct CloseFile {
  void operator()(std::FILE* file) const { std::fclose(file); }
};
using File = std::unique_ptr<std::FILE, CloseFile>;

bool IsAddress(const std::string& name) {
  in6_addr parsed{};
  return inet_pton(AF_INET, name.c_str(), &parsed) == 1 ||
         inet_pton(AF_INET6, name.c_str(), &parsed) == 1;
}

std::string SubjectAlternativeNames() {
  std::string list;
  for (const std::string& name : LocalNames()) {
    if (!list.empty()) list += ',';
    list += (IsAddress(name) ? "IP:" : "DNS:") + name;
  }
  return list;
}

bool AddExtension(X509* certificate, int nid, const std::string& value) {
  X509V3_CTX context;
  X509V3_set_ctx_nodb(&context);
  X509V3_set_ctx(&context, certificate, certificate, nullptr, nullptr, 0);
  const Extension extension(X509V3_EXT_conf_nid(nullptr, &context, nid, value.c_str()));
  return extension && X509_add_ext(certificate, extension.get(), -1) == 1;
}

bool SetSerial(X509* certificate) {
  const Serial serial(BN_new());
  return serial && BN_rand(serial.get(), 127, BN_RAND_TOP_ANY, BN_RAND_BOTTOM_ANY) == 1 &&
         BN_to_ASN1_INTEGER(serial.get(), X509_get_serialNumber(certificate)) != nullptr;
}

// Null when OpenSSL fails.
Certificate MakeCertificate(EVP_PKEY* key) {
  Certificate certificate(X509_new());
  X509* x = certificate.get();
  if (x == nullptr || X509_set_version(x, X509_VERSION_3) != 1 || !SetSerial(x)) return nullptr;
  // A day back, for clients whose clock is behind.
  X509_gmtime_adj(X509_getm_notBefore(x), -kDayS);
  X509_gmtime_adj(X509_getm_notAfter(x), kLifeS);
  X509_NAME* name = X509_get_subject_name(x);
  static constexpr std::array<unsigned char, 12> kName = {'V', 'i', 's', 'i', 'o', 'n',
                                                          'S', 'e', 'r', 'v', 'e', 'r'};
  if (X509_NAME_add_entry_by_txt(name, "CN", MBSTRING_ASC, kName.data(), kName.size(), -1, 0) !=
          1 ||
      X509_set_issuer_name(x, name) != 1 || X509_set_pubkey(x, key) != 1 ||
      !AddExtension(x, NID_basic_constraints, "critical,CA:FALSE") ||
      !AddExtension(x, NID_key_usage, "critical,digitalSignature") ||
      !AddExtension(x, NID_ext_key_usage, "serverAuth") ||
      !AddExtension(x, NID_subject_key_identifier, "hash") ||
      !AddExtension(x, NID_subject_alt_name, SubjectAlternativeNames()) ||
      X509_sign(x, key, EVP_sha256()) == 0) {
    return nullptr;
  }
  return certificate;
}

// Writes beside the target and renames, so that nobody ever sees half a file.
template <class Write>
Status WriteFile(const std::filesystem::path& path, mode_t mode, Write write) {
  const std::filesystem::path draft = path.string() + ".new";
  ::unlink(draft.c_str());
  const int fd = ::open(draft.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, mode);
  if (fd < 0) {
    return FailedPrecondition(Str("cannot write ", draft.string(), ": ", std::strerror(errno)));
  }
  const File file(::fdopen(fd, "w"));
  if (!write(file.get()) || std::fflush(file.get()) != 0 || ::fsync(fd) != 0 ||
      ::rename(draft.c_str(), path.c_str()) != 0) {
    return FailedPrecondition(Str("cannot write ", path.string(), ": ", std::strerror(errno)));
  }
  return Status();
}

Status Generate(const CertificateFiles& files) {
  const Key key(EVP_EC_gen("P-256"));
  const Certificate certificate = key ? MakeCertificate(key.get()) : nullptr;
  if (!certificate) return Internal("OpenSSL cannot make a certificate");
  VS_RETURN_IF_ERROR(WriteFile(files.key, S_IRUSR | S_IWUSR, [&](std::FILE* file) {
    return PEM_write_PKCS8PrivateKey(file, key.get(), nullptr, nullptr, 0, nullptr, nullptr) == 1;
  }));
  return WriteFile(files.certificate, S_IRUSR | S_IWUSR | S_IRGRP | S_IROTH,
                   [&](std::FILE* file) { return PEM_write_X509(file, certificate.get()) == 1; });
}

Result<int64_t> UtcNs(const ASN1_TIME* time) {
  std::tm parts{};
  if (ASN1_TIME_to_tm(time, &parts) != 1) return InvalidArgument("unreadable end of validity");
  return static_cast<int64_t>(::timegm(&parts)) * 1'000'000'000;
}

}  // namespace

std::vector<std::string> LocalNames() {
  std::vector<std::string> names = {"localhost", "127.0.0.1", "::1"};
  const auto add = [&](const std::string& name) {
    if (!name.empty() && std::find(names.begin(), names.end(), name) == names.end()) {
      names.push_back(name);
    }
  };
  std::array<char, 256> host{};
  if (::gethostname(host.data(), host.size() - 1) == 0) add(host.data());

  ifaddrs* interfaces = nullptr;
  if (::getifaddrs(&interfaces) != 0) return names;
  for (const ifaddrs* entry = interfaces; entry != nullptr; entry = entry->ifa_next) {
    if (entry->ifa_addr == nullptr) continue;
    std::array<char, INET6_ADDRSTRLEN> text{};
    if (entry->ifa_addr->sa_family == AF_INET) {
      const auto* v4 = reinterpret_cast<const sockaddr_in*>(entry->ifa_addr);
      add(inet_ntop(AF_INET, &v4->sin_addr, text.data(), text.size()));
    } else if (entry->ifa_addr->sa_family == AF_INET6) {
      const auto* v6 = reinterpret_cast<const sockaddr_in6*>(entry->ifa_addr);
      add(inet_ntop(AF_INET6, &v6->sin6_addr, text.data(), text.size()));
    }
  }
  ::freeifaddrs(interfaces);
  return names;
}

Result<CertificateFiles> EnsureCertificate(const std::filesystem::path& folder) {
  const CertificateFiles files = {.certificate = folder / "server.crt",
                                  .key = folder / "server.key"};
  const bool has_certificate = std::filesystem::exists(files.certificate);
  const bool has_key = std::filesystem::exists(files.key);
  if (has_certificate && has_key) return files;
  if (has_certificate) {
    return FailedPrecondition(Str(files.certificate.string(), " has no key beside it; put ",
                                  files.key.string(), " back or remove the certificate"));
  }
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) return FailedPrecondition(Str("cannot make ", folder.string(), ": ", error.message()));
  // A key without certificate is what a crash between the two leaves.
  VS_RETURN_IF_ERROR(Generate(files));
  return files;
}

Result<CertificateInfo> CheckCertificate(const CertificateFiles& files) {
  const auto open = [](const std::filesystem::path& path) {
    return File(std::fopen(path.c_str(), "re"));
  };
  const File certificate_file = open(files.certificate);
  if (!certificate_file) {
    return FailedPrecondition(
        Str("cannot read ", files.certificate.string(), ": ", std::strerror(errno)));
  }
  const File key_file = open(files.key);
  if (!key_file) {
    return FailedPrecondition(Str("cannot read ", files.key.string(), ": ", std::strerror(errno)));
  }
  const Certificate certificate(PEM_read_X509(certificate_file.get(), nullptr, nullptr, nullptr));
  if (!certificate) {
    return FailedPrecondition(Str(files.certificate.string(), " holds no certificate in PEM form"));
  }
  // An empty pass phrase instead of a question on the terminal.
  std::array<char, 1> no_phrase{};
  const Key key(PEM_read_PrivateKey(key_file.get(), nullptr, nullptr, no_phrase.data()));
  if (!key) {
    return FailedPrecondition(
        Str(files.key.string(), " holds no private key in PEM form (without a pass phrase)"));
  }
  if (X509_check_private_key(certificate.get(), key.get()) != 1) {
    return FailedPrecondition(
        Str(files.key.string(), " is not the key of ", files.certificate.string()));
  }

  CertificateInfo info;
  VS_ASSIGN_OR_RETURN(info.not_after_utc_ns, UtcNs(X509_get0_notAfter(certificate.get())));
  std::array<unsigned char, EVP_MAX_MD_SIZE> digest{};
  unsigned int size = 0;
  if (X509_digest(certificate.get(), EVP_sha256(), digest.data(), &size) != 1) {
    return Internal("OpenSSL cannot hash a certificate");
  }
  for (unsigned int i = 0; i < size; ++i) {
    std::array<char, 4> hex{};
    std::snprintf(hex.data(), hex.size(), i == 0 ? "%02X" : ":%02X", digest[i]);
    info.fingerprint += hex.data();
  }
  return info;
}

}  // namespace vs
