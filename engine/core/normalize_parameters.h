#pragma once

#include "engine/core/sequence_spec.h"

namespace vs {

// Brings the parameters of known blocks into one form, so that specs that mean the same have equal
// JSON: an integer given for a number becomes that number, and a parameter with its initial value
// is left out. What is unknown or does not fit stays as it is.
void NormalizeParameters(SequenceSpec* spec);

}  // namespace vs
