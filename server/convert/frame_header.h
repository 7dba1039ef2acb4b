#pragma once

#include "visionserver/v1/stream.pb.h"

#include "engine/base/clock.h"
#include "engine/core/topic.h"
#include "engine/image/rectified_geometry.h"

namespace vs {

visionserver::v1::RectifiedGeometry ToProto(const RectifiedGeometry& geometry);

// What the header of a published value says about the way of its frame: numbers, revision, capture,
// and one stage for each step that is over, in time order.
void FillJourney(const Sample& sample, const Clock& clock, visionserver::v1::FrameHeader* header);

}  // namespace vs
