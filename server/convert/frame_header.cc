#include "server/convert/frame_header.h"

#include <algorithm>
#include <string>
#include <vector>

#include "server/convert/time.h"

namespace vs {
namespace {

namespace pb = visionserver::v1;

struct Stage {
  std::string name;
  int64_t start_ns;
  int64_t end_ns;
};

std::vector<Stage> StagesOf(const FrameContext& frame) {
  std::vector<Stage> stages;
  const auto add = [&stages](std::string name, int64_t start_ns, int64_t end_ns) {
    if (start_ns != 0 && end_ns != 0) stages.push_back({std::move(name), start_ns, end_ns});
  };
  add("arrival", frame.capture_ns, frame.arrival_ns);
  add("pair", frame.arrival_ns, frame.popped_ns);
  const std::vector<std::string>& ids = frame.run->block_ids;
  for (size_t i = 0; i < ids.size() && i < frame.block_times.size(); ++i) {
    add(ids[i], frame.block_times[i].start_ns, frame.block_times[i].end_ns);
  }
  std::stable_sort(stages.begin(), stages.end(),
                   [](const Stage& a, const Stage& b) { return a.start_ns < b.start_ns; });
  return stages;
}

}  // namespace

pb::RectifiedGeometry ToProto(const RectifiedGeometry& geometry) {
  pb::RectifiedGeometry result;
  result.set_width(static_cast<uint32_t>(geometry.width));
  result.set_height(static_cast<uint32_t>(geometry.height));
  result.set_focal_px(geometry.focal_px);
  result.set_baseline_m(geometry.baseline_m);
  result.set_cx_px(geometry.cx_px);
  result.set_cy_px(geometry.cy_px);
  result.set_principal_offset_px(geometry.principal_offset_px);
  return result;
}

void FillJourney(const Sample& sample, const Clock& clock, pb::FrameHeader* header) {
  const FrameContext& frame = sample.frame;
  header->set_frame_number(frame.number);
  header->set_source_frame_number(frame.source_number);
  header->set_sequence_revision(frame.run->sequence_revision);
  if (frame.capture_ns != 0) {
    header->set_capture_ns(frame.capture_ns);
    *header->mutable_capture_time() =
        ToTimestamp(clock.UtcNs() - (clock.MonotonicNs() - frame.capture_ns));
  }
  for (const Stage& stage : StagesOf(frame)) {
    pb::StageTiming* timing = header->add_timing();
    timing->set_stage(stage.name);
    timing->set_start_ns(stage.start_ns);
    timing->set_end_ns(stage.end_ns);
  }
}

}  // namespace vs
