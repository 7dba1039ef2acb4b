#include "server/storage/atomic_file.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <utility>

#include "engine/base/str.h"

namespace vs {
namespace {

Status SystemError(const std::filesystem::path& file, std::string_view doing, int error) {
  const StatusCode code = error == ENOENT                      ? StatusCode::kNotFound
                          : error == ENOSPC || error == EDQUOT ? StatusCode::kResourceExhausted
                                                               : StatusCode::kFailedPrecondition;
  return Status(code, Str(file.string(), ": cannot ", doing, ": ", std::strerror(error)));
}

class OpenFile {
 public:
  OpenFile(const std::filesystem::path& path, int flags)
      : descriptor_(::open(path.c_str(), flags | O_CLOEXEC, 0640)) {}
  ~OpenFile() {
    if (descriptor_ >= 0) ::close(descriptor_);
  }
  OpenFile(const OpenFile&) = delete;
  OpenFile& operator=(const OpenFile&) = delete;

  bool ok() const { return descriptor_ >= 0; }

  bool Write(std::string_view text) const {
    while (!text.empty()) {
      const ssize_t written = ::write(descriptor_, text.data(), text.size());
      if (written < 0 && errno == EINTR) continue;
      if (written < 0) return false;
      text.remove_prefix(static_cast<size_t>(written));
    }
    return true;
  }

  bool Sync() const { return ::fsync(descriptor_) == 0; }

 private:
  int descriptor_;
};

// What was renamed or removed in the folder is on the disk.
Status SyncFolder(const std::filesystem::path& file) {
  const std::filesystem::path folder = file.has_parent_path() ? file.parent_path() : ".";
  const OpenFile directory(folder, O_RDONLY | O_DIRECTORY);
  if (directory.ok() && directory.Sync()) return Status();
  return SystemError(folder, "synchronise the folder", errno);
}

}  // namespace

Result<std::string> ReadFile(const std::filesystem::path& file, size_t max_bytes) {
  std::error_code error;
  const auto size = std::filesystem::file_size(file, error);
  if (error) return SystemError(file, "be read", error.value());
  if (size > max_bytes) {
    return ResourceExhausted(
        Str(file.string(), ": has ", size, " bytes, at most ", max_bytes, " are read"));
  }
  std::ifstream in(file, std::ios::binary);
  std::string text(size, '\0');
  in.read(text.data(), static_cast<std::streamsize>(size));
  if (!in) return SystemError(file, "be read", errno);
  return text;
}

Status WriteFileAtomically(const std::filesystem::path& file, std::string_view text) {
  const std::filesystem::path draft = file.string() + ".new";
  {
    const OpenFile out(draft, O_WRONLY | O_CREAT | O_TRUNC);
    if (!out.ok()) return SystemError(draft, "be made", errno);
    if (!out.Write(text) || !out.Sync()) {
      const int error = errno;
      ::unlink(draft.c_str());
      return SystemError(file, "be written", error);
    }
  }
  if (std::rename(draft.c_str(), file.c_str()) != 0) {
    return SystemError(file, "be replaced", errno);
  }
  return SyncFolder(file);
}

Status RemoveFile(const std::filesystem::path& file) {
  if (::unlink(file.c_str()) != 0) return SystemError(file, "be removed", errno);
  return SyncFolder(file);
}

Result<std::filesystem::path> PutAside(const std::filesystem::path& file) {
  std::filesystem::path aside;
  for (int n = 1; aside.empty() || std::filesystem::exists(aside); ++n) {
    aside = Str(file.string(), ".damaged-", n);
  }
  if (std::rename(file.c_str(), aside.c_str()) != 0) {
    return SystemError(file, "be put aside", errno);
  }
  return aside;
}

}  // namespace vs
