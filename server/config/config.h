#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "engine/base/status.h"
#include "server/config/server_config.pb.h"

namespace vs {

// Reads the configuration file; server_config.proto says what may be in it. NOT_FOUND when it
// cannot be read, INVALID_ARGUMENT with every fault ("server.conf:12") when it is not right: a
// server never starts with half a configuration. Paths come back absolute.
Result<config::ServerConfig> LoadConfig(const std::filesystem::path& file);

// The same from memory; `name` is the file in messages, relative paths count from `folder`.
Result<config::ServerConfig> ParseConfig(std::string_view text, std::string_view name,
                                         const std::filesystem::path& folder);

// The configuration with every default written out, in the form of the file.
std::string Describe(const config::ServerConfig& config);

}  // namespace vs
