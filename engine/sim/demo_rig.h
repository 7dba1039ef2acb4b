#pragma once

#include "engine/image/rectified_geometry.h"
#include "engine/image/stereo_rig.h"

namespace vs::sim {

// The simulated rig as a calibration of it would describe it: two 1296 x 966 cameras with 4 mm
// lenses, 120 mm apart, with the small misalignment and the lens distortion of a real one. With
// `binning` 2 the same rig as its 648 x 483 pictures show it (any factor that divides the size).
StereoRig DemoRig(int binning = 1);

// The same rig without any fault: its pictures are rectified as they come.
StereoRig IdealRig(int binning = 1);

// The geometry of IdealRig's pictures.
RectifiedGeometry IdealGeometry(int binning = 1);

}  // namespace vs::sim
