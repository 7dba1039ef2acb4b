#include "server/services/resources.h"

#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <string>
#include <thread>

namespace vs {
namespace {

int64_t ToNs(const timeval& time) {
  return static_cast<int64_t>(time.tv_sec) * 1'000'000'000 + time.tv_usec * int64_t{1000};
}

// The lines of /proc/meminfo and /proc/self/status: "MemTotal:       24614556 kB".
uint64_t ReadKilobytes(const char* file, const std::string& key) {
  std::ifstream stream(file);
  std::string word;
  while (stream >> word) {
    uint64_t kilobytes = 0;
    if (word == key && stream >> kilobytes) return kilobytes * 1024;
    std::getline(stream, word);
  }
  return 0;
}

uint32_t CountOpenFiles() {
  std::error_code error;
  const std::filesystem::directory_iterator files("/proc/self/fd", error);
  // Without the one that lists them.
  return error ? 0 : static_cast<uint32_t>(std::distance(begin(files), end(files)) - 1);
}

}  // namespace

Resources ReadResources(const std::filesystem::path& folder) {
  Resources resources;
  resources.cpu_cores = std::thread::hardware_concurrency();
  rusage usage{};
  if (getrusage(RUSAGE_SELF, &usage) == 0) {
    resources.cpu_time_ns = ToNs(usage.ru_utime) + ToNs(usage.ru_stime);
  }
  if (getloadavg(&resources.load_1min, 1) != 1) resources.load_1min = 0;
  resources.memory_total_bytes = ReadKilobytes("/proc/meminfo", "MemTotal:");
  resources.memory_available_bytes = ReadKilobytes("/proc/meminfo", "MemAvailable:");
  resources.memory_server_bytes = ReadKilobytes("/proc/self/status", "VmRSS:");
  std::error_code error;
  const std::filesystem::space_info disk = std::filesystem::space(folder, error);
  if (!error) {
    resources.disk_total_bytes = disk.capacity;
    resources.disk_free_bytes = disk.available;
  }
  resources.open_files = CountOpenFiles();
  rlimit limit{};
  if (getrlimit(RLIMIT_NOFILE, &limit) == 0) {
    resources.open_files_limit =
        static_cast<uint32_t>(std::min<rlim_t>(limit.rlim_cur, UINT32_MAX));
  }
  return resources;
}

}  // namespace vs
