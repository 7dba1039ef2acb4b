#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "engine/base/status.h"
#include "engine/core/sequence_spec.h"

namespace vs {

// A sequence as it is stored.
struct StoredSequence {
  SequenceSpec spec;
  bool autostart = false;  // started by itself when the server starts
  uint64_t revision = 1;   // counts the stored changes
  int64_t created_ns = 0;  // UTC; 0 = unknown
  int64_t updated_ns = 0;  // UTC; 0 = unknown
  std::string updated_by;  // user who stored this revision; empty = unknown
  std::string etag;        // changes with every stored change; not part of the file
};

// The file of a stored sequence: canonical JSON, so that two revisions can be compared by eye.
//   { "autostart": true, "created_ns": ..., "revision": 3, "sequence": { ...see ToJson... },
//     "updated_by": "anna", "updated_ns": ... }
std::string FormatSequenceFile(const StoredSequence& stored);

// INVALID_ARGUMENT with the place. Only "sequence" is required, and a file that is nothing but a
// sequence is accepted, too: so people can write one by hand.
Result<StoredSequence> ParseSequenceFile(std::string_view text);

// "3-9ae1c2..." from the revision and the file's text.
std::string EtagOf(const StoredSequence& stored);

}  // namespace vs
