#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>

#include "engine/base/status.h"

namespace vs {

// NOT_FOUND or FAILED_PRECONDITION with the path and the system's reason; RESOURCE_EXHAUSTED for a
// file of more than `max_bytes`.
Result<std::string> ReadFile(const std::filesystem::path& file, size_t max_bytes);

// Replaces or makes the file in one step: after a crash or a power cut there is the old file or the
// new one, whole. When it returns without error, the new one is on the disk.
// RESOURCE_EXHAUSTED when the disk is full, else FAILED_PRECONDITION.
Status WriteFileAtomically(const std::filesystem::path& file, std::string_view text);

// The file is gone, also after a power cut. NOT_FOUND when there was none.
Status RemoveFile(const std::filesystem::path& file);

// Takes a file that cannot be used out of the way, as FILE.damaged-1 (or -2 ...), and gives its new
// name.
Result<std::filesystem::path> PutAside(const std::filesystem::path& file);

}  // namespace vs
