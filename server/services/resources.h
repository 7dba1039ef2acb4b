#pragma once

#include <cstdint>
#include <filesystem>

namespace vs {

// How much of the machine is used. What the system does not tell is 0.
struct Resources {
  uint32_t cpu_cores = 0;
  int64_t cpu_time_ns = 0;  // of this process since its start, all cores together
  double load_1min = 0;     // runnable threads of the whole machine
  uint64_t memory_total_bytes = 0;
  uint64_t memory_available_bytes = 0;
  uint64_t memory_server_bytes = 0;  // resident
  uint64_t disk_total_bytes = 0;     // of the file system that holds the folder
  uint64_t disk_free_bytes = 0;      // for this user
  uint32_t open_files = 0;
  uint32_t open_files_limit = 0;
};
Resources ReadResources(const std::filesystem::path& folder);

}  // namespace vs
