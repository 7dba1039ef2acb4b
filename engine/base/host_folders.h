#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "engine/base/status.h"

namespace vs {

// Where the paths may lead that users give in parameters and camera addresses. Whoever may build
// sequences on a server shall not thereby read, or write, any file of its machine.
struct HostFolders {
  std::filesystem::path data_dir;  // where relative paths start; empty: there is none
  // Pictures may also be read from below these. Without a server, everything: a program reads what
  // its user may.
  std::vector<std::filesystem::path> picture_roots = {"/"};

  bool operator==(const HostFolders&) const = default;
};

// `text` as a path below `folder`: relative and without "..". INVALID_ARGUMENT when it is not. Only
// the names are looked at: a link below `folder` may lead elsewhere, as whoever made it on this
// machine decided.
Result<std::filesystem::path> PathBelow(const std::filesystem::path& folder,
                                        const std::string& text);

// The file below the data folder that a user means by `text`. INVALID_ARGUMENT when it leads out
// of it, FAILED_PRECONDITION when there is no data folder.
Result<std::filesystem::path> DataPath(const HostFolders& folders, const std::string& text);

// The same for pictures to read: `text` may also be absolute, below the data folder or one of the
// picture roots.
Result<std::filesystem::path> PicturePath(const HostFolders& folders, const std::string& text);

}  // namespace vs
