#pragma once

#include <cstddef>
#include <vector>

#include "engine/base/status.h"
#include "engine/core/sequence_spec.h"

namespace vs {

inline constexpr size_t kMaxBlocks = 1000;
inline constexpr size_t kMaxConnections = 10'000;

// Every fault of the sequence at once, each with its block ("match", or "blocks[2]" when its id is
// unusable), parameter ("match.p1"), port ("match.left") or "sequence": too many blocks, unknown
// types, duplicate or malformed ids, parameters unknown, of the wrong type, out of range or at odds
// with each other, connections to nowhere, between different types, twice into one input, required
// inputs left open, cycles (naming the blocks on it), no source. Empty = it can be loaded.
std::vector<Fault> CheckSequence(const SequenceSpec& spec);

// Only what is wrong with the parameters of one block when taken together and with its connections,
// see Block::CheckParams; those that are not named have their initial values. `connections` are all
// of its sequence. None when the type is unknown or a value does not fit by itself: that is another
// fault, and may well be the cause.
std::vector<Fault> CheckParamsTogether(const BlockSpec& spec,
                                       const std::vector<Connection>& connections);

}  // namespace vs
