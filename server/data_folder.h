#pragma once

#include <filesystem>
#include <utility>

#include "engine/base/status.h"

namespace vs {

// The folder that holds everything a server stores, taken for this process alone: two servers on
// the same data would ruin it. Given back when the object goes or the process dies.
class DataFolder {
 public:
  // Makes the folder, readable by its owner only, when there is none. FAILED_PRECONDITION when
  // another server has it or it cannot be written.
  static Result<DataFolder> Take(const std::filesystem::path& path);
  DataFolder(DataFolder&& other) noexcept
      : path_(std::move(other.path_)), lock_(std::exchange(other.lock_, -1)) {}
  DataFolder& operator=(DataFolder&&) = delete;
  ~DataFolder();

  const std::filesystem::path& path() const { return path_; }

 private:
  DataFolder(std::filesystem::path path, int lock) : path_(std::move(path)), lock_(lock) {}

  std::filesystem::path path_;
  int lock_;
};

}  // namespace vs
