#pragma once

#include <cstdint>
#include <deque>
#include <filesystem>
#include <string>
#include <vector>

#include "engine/base/status.h"

namespace vs {

// A folder that takes pictures up to a limit. Not thread-safe; the only writer of its folder.
class PictureFolder {
 public:
  struct Limits {
    int64_t max_files = 0;
    int64_t max_bytes = 0;       // of all files together
    int64_t min_free_bytes = 0;  // on the file system; nothing is written below that
    bool delete_oldest = false;  // make room; otherwise refuse what is too much
  };

  // Makes the folder if necessary and counts the *.png and *.ply files that are in it.
  // FAILED_PRECONDITION when it cannot be used.
  static Result<PictureFolder> Open(const std::filesystem::path& folder);

  // Writes the file whole or not at all; the oldest file is that with the smallest name.
  // RESOURCE_EXHAUSTED when the limits or the disk do not allow it, which also says what to do.
  Status Write(const std::string& name, const std::vector<uint8_t>& content, const Limits& limits);

  int64_t files() const { return static_cast<int64_t>(entries_.size()); }
  int64_t bytes() const { return bytes_; }

 private:
  struct Entry {
    std::string name;
    int64_t bytes;
  };

  explicit PictureFolder(std::filesystem::path folder) : folder_(std::move(folder)) {}
  Status MakeRoom(int64_t bytes, const Limits& limits);
  void DeleteOldest();

  std::filesystem::path folder_;
  std::deque<Entry> entries_;  // by name
  int64_t bytes_ = 0;
};

}  // namespace vs
