#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "engine/core/block.h"
#include "engine/core/sequence_spec.h"

namespace vs {

// What a TestStep saw in one run.
struct StepRun {
  const FrameContext& frame;
  int64_t a;
  std::optional<int64_t> b;
  int64_t offset;
};

// What a test block does besides its arithmetic, by the value of its parameter "probe". Set before
// the sequence starts; called on the workers.
struct Probe {
  std::function<Status()> start;
  std::function<bool()> ready;                // of a TestSource
  std::function<SourceReport()> report;       // of a TestSource
  std::function<Status(const StepRun&)> run;  // a = the count, for a TestSource
  std::function<void()> stop;
  std::function<void()> check;                           // of a TestLimits, in CheckParams()
  std::function<void(std::function<void()>)> take_wake;  // gets the source's Wake() at its start
};

// The probe of this name, made on first use.
Probe& ProbeOf(const std::string& name);
// Forgets all probes. At the end of each test.
void ClearProbes();

// Types to wire up; all ports are integers unless named otherwise:
//   TestSource  -> value                     counts 1, 2, 3 ...
//   TestStep    a, b (optional) -> sum       a + b + offset; parameters offset, fixed (not live)
//   TestNumber  in (number) -> out (number)
//   TestLimits  a (any)                      parameters low <= high, initially 0 and 10
//   TestSome    a, b (any, one of them) -> count of values
BlockSpec SourceSpec(const std::string& id);
// With "probe" = id.
BlockSpec StepSpec(const std::string& id);
Connection Wire(const std::string& from, const std::string& to);  // "camera.value", "step.a"

// Source "source" and steps with these ids, one behind the other.
SequenceSpec ChainSpec(const std::string& id, const std::vector<std::string>& steps);

}  // namespace vs
