#pragma once

#include <optional>
#include <string>
#include <vector>

#include "visionserver/v1/camera.pb.h"
#include "visionserver/v1/result.pb.h"
#include "visionserver/v1/sequence.pb.h"
#include "visionserver/v1/session.pb.h"
#include "visionserver/v1/stream.pb.h"

#include "client/error.h"

namespace vs::cli {

// The enumerations of the interface as words: ROLE_ADMIN is "admin".
std::string RoleWord(visionserver::v1::Role role);
std::string CameraStateWord(visionserver::v1::CameraState state);
std::string FeatureTypeWord(visionserver::v1::FeatureType type);
std::string RunStateWord(visionserver::v1::SequenceRunState state);
std::string StreamKindWord(visionserver::v1::StreamKind kind);
std::string ResultClassWord(visionserver::v1::ResultClass result_class);

// The way back. INVALID_ARGUMENT names the words there are.
client::Result<visionserver::v1::Role> ParseRole(const std::string& word);
client::Result<visionserver::v1::ResultClass> ParseResultClass(const std::string& word);

// "2026-01-31T14:03:00Z", or a local "2026-01-31 14:03:00" or "2026-01-31".
client::Result<google::protobuf::Timestamp> ParseTime(const std::string& text);

}  // namespace vs::cli
