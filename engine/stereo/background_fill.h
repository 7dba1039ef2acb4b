#pragma once

#include "engine/image/disparity_map.h"

namespace vs {

// Fills each run of invalid pixels in a row with the smaller (farther) of the two stored
// disparities next to it, or the only one, with kFilledConfidence: what is hidden from one camera
// belongs to the background. A row without any disparity stays as it is. In place, rows
// [begin, end).
void FillBackgroundRows(int begin, int end, DisparityMap* map);

}  // namespace vs
