#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "engine/base/status.h"
#include "engine/core/param.h"

namespace vs {

struct BlockSpec {
  std::string id;    // stable within the sequence: [a-z][a-z0-9_]*, at most 63 characters
  std::string type;  // name in the registry
  std::map<std::string, ParamValue> params;  // the others have their initial values
  double x = 0;                              // place in the editor
  double y = 0;

  bool operator==(const BlockSpec&) const = default;
};

// From an output to an input. An output may feed many inputs, an input has one source.
struct Connection {
  std::string from_block;
  std::string from_port;
  std::string to_block;
  std::string to_port;

  auto operator<=>(const Connection&) const = default;  // NOLINT(modernize-use-nullptr)
};

// A sequence as plain data: what is stored, sent, compared and edited.
struct SequenceSpec {
  std::string id;                // like a block's id
  std::string description;       // for people
  int priority = 0;              // -10 .. 10; higher runs first when workers are short
  int max_frames_in_flight = 2;  // 1 .. 16; more = higher rate on several cores, never more delay
                                 // than that many frames
  double latency_budget_ms = 0;  // 0 .. 60000; from capture to the end of the last block; slower
                                 // frames are counted. 0 = no limit
  std::vector<BlockSpec> blocks;
  std::vector<Connection> connections;

  bool operator==(const SequenceSpec&) const = default;
};

// "stereo_depth": [a-z][a-z0-9_]*, at most 63 characters.
bool IsSequenceId(std::string_view text);
// The same as a check of a parameter that is such a name.
Status CheckSequenceId(const std::string& text);

// Canonical JSON: keys sorted, blocks and connections sorted, two spaces, numbers in their shortest
// exact form. Equal specs give equal text whatever the order of their blocks and connections, so a
// diff shows what changed; NormalizeParameters makes specs equal that only mean the same. Numbers
// must be finite (CheckSequence says whether they are).
std::string ToJson(const SequenceSpec& spec);

inline constexpr size_t kMaxSequenceBytes = 1 << 20;

// The reverse; blocks and connections keep the order of the text. Only "id" and a block's "id" and
// "type" are required. INVALID_ARGUMENT for malformed JSON (with line and column), text of more
// than 1 MiB, unknown and duplicate keys and wrong types, each with its place
// ("blocks[2].params.p1"). Whether blocks exist and fit is CheckSequence's question.
Result<SequenceSpec> ParseSequence(std::string_view json);

}  // namespace vs
