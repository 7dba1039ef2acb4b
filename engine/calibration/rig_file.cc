#include "engine/calibration/rig_file.h"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <string>
#include <string_view>
#include <system_error>

#include "engine/base/str.h"
#include "engine/calibration/rig_json.h"
#include "engine/calibration/validate_rig.h"

namespace vs {
namespace {

Status SystemError(const std::filesystem::path& path, const char* action) {
  const std::string message =
      Str(path.string(), ": cannot ", action, ": ", std::system_category().message(errno));
  switch (errno) {
    case ENOENT:
    case ENOTDIR:
      return NotFound(message);
    case EACCES:
    case EPERM:
    case EROFS:
      return PermissionDenied(message);
    case ENOSPC:
    case EDQUOT:
      return ResourceExhausted(message);
    default:
      return Unavailable(message);
  }
}

// A file descriptor that closes itself.
class File {
 public:
  File(const std::filesystem::path& path, int flags) : fd_(open(path.c_str(), flags, 0644)) {}
  ~File() {
    if (fd_ >= 0) close(fd_);
  }
  File(const File&) = delete;
  File& operator=(const File&) = delete;

  bool ok() const { return fd_ >= 0; }
  bool Write(std::string_view text) const {
    while (!text.empty()) {
      const ssize_t written = write(fd_, text.data(), text.size());
      if (written < 0 && errno == EINTR) continue;
      if (written < 0) return false;
      text.remove_prefix(static_cast<size_t>(written));
    }
    return true;
  }
  // At most `limit` bytes.
  bool Read(size_t limit, std::string* text) const {
    std::array<char, 4096> chunk;
    while (text->size() < limit) {
      const ssize_t got = read(fd_, chunk.data(), std::min(chunk.size(), limit - text->size()));
      if (got < 0 && errno == EINTR) continue;
      if (got < 0) return false;
      if (got == 0) break;
      text->append(chunk.data(), static_cast<size_t>(got));
    }
    return true;
  }
  bool Sync() const { return fsync(fd_) == 0; }

 private:
  int fd_;
};

}  // namespace

Result<StereoRig> LoadRig(const std::filesystem::path& path) {
  const File file(path, O_RDONLY | O_CLOEXEC);
  std::string text;
  if (!file.ok()) return SystemError(path, "open");
  if (!file.Read(kLargestRigBytes + 1, &text)) return SystemError(path, "read");
  Result<StereoRig> rig = ParseRig(text);
  if (!rig) return rig.error().Annotated(path.string());
  return rig;
}

Status SaveRig(const StereoRig& rig, const std::filesystem::path& path) {
  VS_RETURN_IF_ERROR(ValidateRig(rig));
  // Beside the target, because only within one file system a rename replaces in one step.
  std::filesystem::path temporary = path;
  temporary += Str(".new.", getpid());
  {
    const File file(temporary, O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC);
    if (!file.ok()) return SystemError(temporary, "create");
    if (!file.Write(FormatRig(rig)) || !file.Sync()) {
      Status status = SystemError(temporary, "write");
      unlink(temporary.c_str());
      return status;
    }
  }
  if (rename(temporary.c_str(), path.c_str()) != 0) {
    Status status = SystemError(path, "replace");
    unlink(temporary.c_str());
    return status;
  }
  const std::filesystem::path folder = path.has_parent_path() ? path.parent_path() : ".";
  const File directory(folder, O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (!directory.ok() || !directory.Sync()) return SystemError(folder, "save");
  return {};
}

}  // namespace vs
