#pragma once

#include <cstdint>
#include <vector>

#include "engine/image/buffer.h"
#include "engine/image/disparity_map.h"
#include "engine/image/image.h"
#include "engine/stereo/filter_kernels.h"
#include "engine/stereo/gated_filter.h"
#include "engine/stereo/sgm_settings.h"
#include "engine/stereo/thread_team.h"

namespace vs {

// A map of this size, to be written; its geometry holds the size only.
DisparityMap MakeDisparityMap(int width, int height, int offset_px, BufferPool& pool);

// The filters that SgmSettings asks for, one after the other over a whole map, by the threads of
// `team`. Keeps scratch memory.
class Refiner {
 public:
  explicit Refiner(const FilterKernels& kernels = PlainFilterKernels()) : kernels_(kernels) {}

  void Refine(const GreyImage& left, const SgmSettings& settings, int parts, ThreadTeam* team,
              BufferPool& pool, DisparityMap* map);

 private:
  struct Scratch {
    std::vector<uint16_t> median;
    GatedFilterScratch gated;
  };

  const FilterKernels& kernels_;
  std::vector<Scratch> scratch_;  // by part
};

}  // namespace vs
