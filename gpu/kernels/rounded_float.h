// Floats as the CPU computes them: each operation is rounded by itself, so that results are equal
// to the last bit, whatever the compiler is told.
#pragma once

#include "gpu/kernels/simt.h"

namespace vs::gpu {

struct RoundedFloat {
  float value = 0;

  friend VS_DEVICE RoundedFloat operator+(RoundedFloat a, RoundedFloat b) {
    return {AddFloats(a.value, b.value)};
  }
  friend VS_DEVICE RoundedFloat operator-(RoundedFloat a, RoundedFloat b) {
    return {AddFloats(a.value, -b.value)};
  }
  friend VS_DEVICE RoundedFloat operator*(RoundedFloat a, RoundedFloat b) {
    return {MultiplyFloats(a.value, b.value)};
  }
  friend VS_DEVICE RoundedFloat operator/(RoundedFloat a, RoundedFloat b) {
    return {DivideFloats(a.value, b.value)};
  }
};

}  // namespace vs::gpu
