#pragma once

#include <memory>
#include <string>
#include <vector>

#include "engine/base/status.h"
#include "engine/core/param.h"
#include "engine/core/run.h"
#include "engine/core/sequence.h"
#include "engine/core/sequence_spec.h"

namespace vs {

// A parameter of one block of a sequence, with its value.
struct BlockParameter {
  std::string block;                       // id
  std::string type;                        // of the block
  std::shared_ptr<const ParamBase> param;  // for its description; its own value means nothing
  ParamValue value;

  const ParamInfo& info() const { return param->info(); }
};

// All parameters of a stored sequence, in the order of its blocks; blocks of unknown type have
// none.
std::vector<BlockParameter> ParametersOf(const SequenceSpec& spec);
// All parameters of a running sequence with the values in effect.
std::vector<BlockParameter> ParametersOf(const std::shared_ptr<const Run>& run);

// Whose right and moment a change is checked for.
struct ChangeRules {
  bool operators_only = false;  // only parameters that are marked for operators
  bool running = false;         // only parameters that may change while the sequence runs
};

// The assignments with their values in the parameters' own types (an integer for a number becomes
// that number), or all that is wrong with them at once: INVALID_ARGUMENT for unknown names, wrong
// types and ranges, values that do not go together or with the `connections` of the sequence, and a
// parameter named twice; else PERMISSION_DENIED or FAILED_PRECONDITION.
Result<std::vector<ParamAssignment>> CheckAssignments(
    const std::vector<BlockParameter>& parameters, const std::vector<Connection>& connections,
    const std::vector<ParamAssignment>& assignments, const ChangeRules& rules);

// The initial values of the parameters `paths` ("block.parameter"; empty for all of them, but
// without those that the rules forbid).
Result<std::vector<ParamAssignment>> InitialValues(const std::vector<BlockParameter>& parameters,
                                                   const std::vector<Connection>& connections,
                                                   const std::vector<std::string>& paths,
                                                   const ChangeRules& rules);

// Writes checked values into a spec. Blocks that the spec does not have, or has with another type,
// are left out.
void Store(const std::vector<ParamAssignment>& checked,
           const std::vector<BlockParameter>& parameters, SequenceSpec* spec);

// "block.parameter" in its two parts; INVALID_ARGUMENT when it is not that.
Result<ParamAssignment> SplitPath(const std::string& path);

}  // namespace vs
