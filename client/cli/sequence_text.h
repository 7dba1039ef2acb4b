#pragma once

#include <string>

#include "visionserver/v1/sequence.pb.h"

#include "client/error.h"

namespace vs::cli {

// A sequence as the JSON that people edit and version:
//   {"id": "stereo_depth", "description": "...", "priority": 0, "max_frames_in_flight": 2,
//    "blocks": [{"id": "match", "type": "sgm_stereo", "params": {"p2": 96}, "x": 0, "y": 0}],
//    "connections": [{"from": "camera.frame", "to": "match.frame"}]}
// Keys, blocks and connections are sorted, so that a diff shows what changed.
std::string SequenceToJson(const std::string& id, const visionserver::v1::SequenceSpec& spec);

struct NamedSpec {
  std::string id;  // empty when the text names none
  visionserver::v1::SequenceSpec spec;
};

// The way back. INVALID_ARGUMENT for malformed JSON, unknown keys and wrong types, with their
// place; whether the blocks exist and fit is for the server to say.
client::Result<NamedSpec> SequenceFromJson(const std::string& text);

// The same from a file; "-" is standard input.
client::Result<NamedSpec> ReadSequenceFile(const std::string& path);

}  // namespace vs::cli
