#pragma once

#include <cstdint>
#include <vector>

#include "engine/sim/vec3.h"

namespace vs::sim {

// How a surface looks: every one carries a random texture, fine enough to be matched.
struct Surface {
  double mean_grey = 128;     // at nominal exposure, facing the light
  double contrast_grey = 80;  // from the mean to the darkest and brightest places
  double pattern_m = 0;       // where in the endless texture this surface begins
};

// An endless plane through a point of it. axes[2] points out of it, towards the cameras; its
// texture runs along the other two, from that point.
struct Plane {
  Vec3 point_m;
  Axes axes;
  Surface surface;
};

struct Box {
  Vec3 center_m;
  Axes axes;
  Vec3 half_size_m;  // along the axes
  Surface surface;
};

struct Sphere {
  Vec3 center_m;
  Axes axes;  // its texture turns with them
  double radius_m = 0;
  Surface surface;
};

// What the simulated cameras look at, in the frame of the rig's left camera: a tilted table with
// things on it, one of which (the part) slides to and fro and turns.
struct Scene {
  Plane table;
  std::vector<Box> boxes;
  std::vector<Sphere> spheres;
};

// The scene at rest: all but the part.
Scene DemoScene();

// Where the part is at an instant (nanoseconds; any zero). The one thing in the scene that depends
// on time, and it depends on nothing else: two cameras that are triggered at the same instant see
// the same scene. The motion repeats every 24 s and is never faster than 0.1 m/s.
Box DemoPart(int64_t instant_ns);

}  // namespace vs::sim
