#include "engine/image/picture_folder.h"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <system_error>
#include <utility>

#include "engine/base/str.h"

namespace vs {
namespace {

namespace fs = std::filesystem;

Status WriteWhole(const fs::path& path, const std::vector<uint8_t>& content) {
  const int file = open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0644);
  int error = file < 0 ? errno : 0;
  size_t written = 0;
  while (error == 0 && written < content.size()) {
    const ssize_t count = write(file, content.data() + written, content.size() - written);
    if (count >= 0) {
      written += static_cast<size_t>(count);
    } else if (errno != EINTR) {
      error = errno;
    }
  }
  if (file >= 0 && close(file) != 0 && error == 0) error = errno;
  if (error == 0) return Status();
  return ResourceExhausted(
      Str(path.string(), " cannot be written: ", std::generic_category().message(error)));
}

}  // namespace

Result<PictureFolder> PictureFolder::Open(const fs::path& folder) {
  PictureFolder opened(folder);
  std::error_code error;
  fs::create_directories(folder, error);
  std::vector<Entry> found;
  if (!error) {
    for (auto file = fs::directory_iterator(folder, error);
         !error && file != fs::directory_iterator(); file.increment(error)) {
      std::error_code gone;
      const auto extension = file->path().extension();
      const bool counts = extension == ".png" || extension == ".ply";
      const auto bytes = counts ? file->file_size(gone) : 0;
      if (!gone && counts) {
        found.push_back({file->path().filename().string(), static_cast<int64_t>(bytes)});
      }
    }
  }
  if (error) {
    return FailedPrecondition(
        Str("pictures cannot be kept in ", folder.string(), ": ", error.message()));
  }
  std::sort(found.begin(), found.end(),
            [](const Entry& a, const Entry& b) { return a.name < b.name; });
  for (const Entry& entry : found) opened.bytes_ += entry.bytes;
  opened.entries_.assign(found.begin(), found.end());
  return opened;
}

Status PictureFolder::Write(const std::string& name, const std::vector<uint8_t>& content,
                            const Limits& limits) {
  const auto bytes = static_cast<int64_t>(content.size());
  VS_RETURN_IF_ERROR(MakeRoom(bytes, limits));
  const fs::path draft = folder_ / (name + ".part");
  std::error_code error;
  if (Status status = WriteWhole(draft, content); !status.ok()) {
    fs::remove(draft, error);
    return status;
  }
  fs::rename(draft, folder_ / name, error);
  if (error) {
    std::error_code ignored;
    fs::remove(draft, ignored);
    return ResourceExhausted(
        Str((folder_ / name).string(), " cannot be written: ", error.message()));
  }
  const auto place = std::lower_bound(
      entries_.begin(), entries_.end(), name,
      [](const Entry& entry, const std::string& other) { return entry.name < other; });
  entries_.insert(place, {name, bytes});
  bytes_ += bytes;
  return Status();
}

Status PictureFolder::MakeRoom(int64_t bytes, const Limits& limits) {
  if (bytes > limits.max_bytes) {
    return ResourceExhausted(
        Str("one picture of ", bytes, " bytes is more than the folder may hold"));
  }
  while (files() + 1 > limits.max_files || bytes_ + bytes > limits.max_bytes) {
    if (!limits.delete_oldest) {
      return ResourceExhausted(Str(folder_.string(), " is full with ", files(), " pictures in ",
                                   bytes_, " bytes: move some away or raise the limits"));
    }
    DeleteOldest();
  }
  std::error_code error;
  const fs::space_info space = fs::space(folder_, error);
  if (error || static_cast<int64_t>(space.available) - bytes < limits.min_free_bytes) {
    return ResourceExhausted(Str("the disk of ", folder_.string(),
                                 " is nearly full: free some space to save pictures again"));
  }
  return Status();
}

void PictureFolder::DeleteOldest() {
  std::error_code ignored;  // whoever removed it before did us a service
  fs::remove(folder_ / entries_.front().name, ignored);
  bytes_ -= entries_.front().bytes;
  entries_.pop_front();
}

}  // namespace vs
