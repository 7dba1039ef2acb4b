#include "engine/base/host_folders.h"

#include <algorithm>

#include "engine/base/str.h"

namespace vs {
namespace {

namespace fs = std::filesystem;

bool ClimbsUp(const fs::path& path) {
  return std::find(path.begin(), path.end(), "..") != path.end();
}

// Both without "..", so that the names alone tell.
bool LiesBelow(const fs::path& path, const fs::path& folder) {
  const fs::path relative = path.lexically_normal().lexically_relative(folder.lexically_normal());
  return !relative.empty() && *relative.begin() != "..";
}

}  // namespace

Result<fs::path> PathBelow(const fs::path& folder, const std::string& text) {
  const fs::path path(text);
  if (!path.empty() && path.is_relative() && !ClimbsUp(path)) return folder / path;
  return InvalidArgument(Str(Quoted(text), " must be a relative path without \"..\""));
}

Result<fs::path> DataPath(const HostFolders& folders, const std::string& text) {
  if (folders.data_dir.empty()) {
    return FailedPrecondition(
        Str("there is no data folder for ", Quoted(text), ": run this sequence on a server"));
  }
  if (auto path = PathBelow(folders.data_dir, text)) return path;
  return InvalidArgument(Str(Quoted(text),
                             " leads out of the server's data folder; give a path relative to it, "
                             "without \"..\""));
}

Result<fs::path> PicturePath(const HostFolders& folders, const std::string& text) {
  const fs::path path(text);
  if (path.is_relative()) return DataPath(folders, text);
  const auto holds = [&path](const fs::path& folder) { return LiesBelow(path, folder); };
  const bool in_data = !folders.data_dir.empty() && holds(folders.data_dir);
  if (!ClimbsUp(path) && (in_data || std::ranges::any_of(folders.picture_roots, holds))) {
    return path;
  }
  return InvalidArgument(Str(Quoted(text),
                             " is outside the folders that this server reads pictures from; move "
                             "them below its data folder, or let the server's configuration name "
                             "a picture_root above them"));
}

}  // namespace vs
