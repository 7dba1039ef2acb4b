#pragma once

#include <vector>

#include "engine/base/status.h"
#include "engine/core/sequence_spec.h"

namespace vs {

// Every fault of the sequence at once, each with its block ("match"), parameter ("match.p1"), port
// ("match.left") or "sequence": unknown types, duplicate or malformed ids, parameters unknown, of
// the wrong type or out of range, connections to nowhere, between different types, twice into one
// input, required inputs left open, cycles (naming the blocks on it), no source. Empty = it can be
// loaded.
std::vector<Fault> CheckSequence(const SequenceSpec& spec);

}  // namespace vs
