// The straight way of a frame over the device. `launch(kernel, grid, threads in a block,
// arguments...)` starts a kernel after those before it; each stage is a file of its own.
#pragma once

#include "gpu/frame.h"
#include "gpu/kernels/condition.h"
#include "gpu/kernels/costs.h"
#include "gpu/kernels/depth.h"
#include "gpu/kernels/features.h"
#include "gpu/kernels/filters.h"
#include "gpu/kernels/judge.h"
#include "gpu/kernels/paths.h"
#include "gpu/kernels/rectify.h"
#include "gpu/kernels/winners.h"

namespace vs::gpu {

// Returns where the map is; DownloadOf (gpu/download.h) says what is wanted of a frame.
template <class Launch>
DeviceMap RunStages(Launch& launch, const Frame& frame) {
  Rectify(launch, frame);                       // uploaded -> input
  Condition(launch, frame);                     // input -> grey
  MakeFeatures(launch, frame);                  // grey -> code
  MakeCosts(launch, frame);                     // code -> costs
  SumPaths(launch, frame);                      // costs -> sums
  SelectWinners(launch, frame);                 // sums -> winner, right_index
  Judge(launch, frame);                         // winner -> map[0]
  const DeviceMap map = Refine(launch, frame);  // map[0] -> one of both
  MakeDepth(launch, frame, map);                // map -> depth_m
  return map;
}

}  // namespace vs::gpu
