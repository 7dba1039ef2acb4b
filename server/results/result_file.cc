#include "server/results/result_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "engine/base/host_folders.h"
#include "engine/base/str.h"

namespace vs {
namespace {

namespace fs = std::filesystem;

// Empty for what is not given away.
std::string MediaTypeOf(const fs::path& file) {
  if (file.extension() == ".png") return "image/png";
  if (file.extension() == ".ply") return "model/ply";
  return "";
}

Status NotAPicture(const std::string& path) {
  return InvalidArgument(
      Str(Quoted(path),
          " is not a PNG or PLY file below the server's data folder; name a field "
          "that holds SaveImages.path"));
}

// Where it really lies, links followed.
Result<fs::path> Locate(const fs::path& data_dir, const std::string& path) {
  const Result<fs::path> named = PathBelow(data_dir, path);
  if (!named || MediaTypeOf(*named).empty()) return NotAPicture(path);
  std::error_code error;
  const fs::path folder = fs::canonical(data_dir, error);
  const fs::path file = error ? fs::path() : fs::canonical(*named, error);
  if (error) {
    return NotFound(Str("the file ", Quoted(path), " is not there (any more): ", error.message()));
  }
  const fs::path relative = file.lexically_relative(folder);
  if (relative.empty() || *relative.begin() == ".." || MediaTypeOf(file).empty()) {
    return NotAPicture(path);
  }
  return file;
}

Result<std::string> ReadAll(int fd, const std::string& path) {
  struct stat facts {};
  if (fstat(fd, &facts) != 0 || !S_ISREG(facts.st_mode)) return NotAPicture(path);
  const auto size = static_cast<size_t>(facts.st_size);
  if (size > kMaxResultFileBytes) {
    return ResourceExhausted(Str("the file ", Quoted(path), " has ", size, " bytes, more than the ",
                                 kMaxResultFileBytes,
                                 " that can be fetched; copy it from the "
                                 "server's data folder"));
  }
  std::string data(size, '\0');
  size_t done = 0;
  while (done < size) {
    const ssize_t got = read(fd, data.data() + done, size - done);
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) return Unavailable(Str("cannot read ", Quoted(path), ": ", std::strerror(errno)));
    done += static_cast<size_t>(got);
  }
  return data;
}

}  // namespace

Result<ResultFile> ReadResultFile(const fs::path& data_dir, const std::string& path) {
  VS_ASSIGN_OR_RETURN(const fs::path file, Locate(data_dir, path));
  // Without waiting for the other end of a pipe, and without a link that has just been put there.
  const int fd = open(file.c_str(), O_RDONLY | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK);
  if (fd < 0) {
    return NotFound(
        Str("the file ", Quoted(path), " cannot be opened (any more): ", std::strerror(errno)));
  }
  Result<std::string> data = ReadAll(fd, path);
  close(fd);
  if (!data) return data.error();
  return ResultFile{
      .name = file.filename().string(), .media_type = MediaTypeOf(file), .data = *std::move(data)};
}

}  // namespace vs
