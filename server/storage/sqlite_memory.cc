#include "server/storage/sqlite_memory.h"

#include <sqlite3.h>

namespace vs {
namespace {

thread_local int64_t bytes_of_thread = 0;
sqlite3_mem_methods plain;  // SQLite's own
bool counting = false;

int64_t SizeOf(void* memory) { return memory == nullptr ? 0 : plain.xSize(memory); }

void* Allocate(int size_bytes) {
  void* memory = plain.xMalloc(size_bytes);
  bytes_of_thread += SizeOf(memory);
  return memory;
}

void Free(void* memory) {
  bytes_of_thread -= SizeOf(memory);
  plain.xFree(memory);
}

void* Reallocate(void* memory, int size_bytes) {
  const int64_t before = SizeOf(memory);
  void* moved = plain.xRealloc(memory, size_bytes);
  // Where there is no memory, all stays as it was.
  if (moved != nullptr) bytes_of_thread += SizeOf(moved) - before;
  return moved;
}

}  // namespace

void CountSqliteMemory() {
  [[maybe_unused]] static const bool once = [] {
    if (sqlite3_config(SQLITE_CONFIG_GETMALLOC, &plain) != SQLITE_OK) return false;
    sqlite3_mem_methods methods = plain;
    methods.xMalloc = Allocate;
    methods.xFree = Free;
    methods.xRealloc = Reallocate;
    counting = sqlite3_config(SQLITE_CONFIG_MALLOC, &methods) == SQLITE_OK;
    return counting;
  }();
}

int64_t SqliteBytesOfThread() { return counting ? bytes_of_thread : sqlite3_memory_used(); }

}  // namespace vs
