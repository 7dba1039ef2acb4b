#pragma once

#include <string>

#include "visionserver/v1/sequence.pb.h"

#include "engine/base/status.h"
#include "engine/core/param.h"
#include "engine/core/registry.h"
#include "engine/core/sequence_spec.h"
#include "server/sequences/sequence_instance.h"
#include "server/sequences/stored_sequence.h"

namespace vs {

visionserver::v1::SequenceSpec ToProto(const SequenceSpec& spec);
// INVALID_ARGUMENT with all faults of form; whether blocks exist and fit is CheckSequence's
// question.
Result<SequenceSpec> FromProto(const std::string& id, const visionserver::v1::SequenceSpec& spec);

// Without spec unless `with_spec`.
visionserver::v1::Sequence ToProto(const StoredSequence& stored, const SequenceStatus& status,
                                   bool with_spec);
visionserver::v1::SequenceState ToProto(const SequenceStatus& status);
visionserver::v1::SequenceRunState ToProto(Activity activity);

visionserver::v1::ParameterInfo ToProto(const ParamInfo& info);
visionserver::v1::BlockType ToProto(const BlockRegistry::Entry& entry);

visionserver::v1::Fault ToProto(const Fault& fault);

}  // namespace vs
