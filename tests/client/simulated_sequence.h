#pragma once

#include <string>

namespace vs::test {

// A sequence that makes its own pictures, small enough to be matched several times a second by the
// slowest build, publishes depth and logs a result for each frame.
inline std::string SimulatedSequence(const std::string& id) {
  return R"({"id": ")" + id + R"(",
  "description": "Simulated depth.",
  "blocks": [
    {"id": "source", "type": "SimulatedStereo", "params": {"rate_hz": 5.0}},
    {"id": "small", "type": "Resize", "params": {"scale": 0.2}},
    {"id": "match", "type": "SgmStereo", "params": {"num_disparities": 32}},
    {"id": "publish", "type": "Publish", "params": {"stream": "depth"}},
    {"id": "quality", "type": "DepthQuality"},
    {"id": "judge", "type": "RangeCheck", "params": {"limits": "min", "min": 1.0}},
    {"id": "log", "type": "LogResult", "params": {"name_a": "valid_percent"}}
  ],
  "connections": [
    {"from": "source.pair", "to": "small.pair"},
    {"from": "small.resized", "to": "match.pair"},
    {"from": "match.disparity", "to": "publish.value"},
    {"from": "match.disparity", "to": "quality.disparity"},
    {"from": "quality.valid", "to": "judge.value"},
    {"from": "quality.valid", "to": "log.a"},
    {"from": "judge.result_class", "to": "log.result_class"}
  ]})";
}

}  // namespace vs::test
