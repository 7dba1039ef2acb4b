#include "server/data_folder.h"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "engine/base/str.h"

namespace vs {

Result<DataFolder> DataFolder::Take(const std::filesystem::path& path) {
  std::error_code error;
  const bool made = std::filesystem::create_directories(path, error);
  if (error) {
    return FailedPrecondition(
        Str("cannot make the data folder ", path.string(), ": ", error.message()));
  }
  if (made) std::filesystem::permissions(path, std::filesystem::perms::owner_all, error);
  const std::filesystem::path lock_file = path / "lock";
  const int lock = ::open(lock_file.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, S_IRUSR | S_IWUSR);
  if (lock < 0) {
    return FailedPrecondition(Str("cannot write in the data folder ", path.string(), ": ",
                                  std::strerror(errno), "; give this user the right to"));
  }
  if (::flock(lock, LOCK_EX | LOCK_NB) != 0) {
    ::close(lock);
    return FailedPrecondition(Str("the data folder ", path.string(),
                                  " is in use by another server; stop it, or take another folder"));
  }
  return DataFolder(path, lock);
}

DataFolder::~DataFolder() {
  if (lock_ >= 0) ::close(lock_);
}

}  // namespace vs
