#pragma once

#include <cstdint>

#include "engine/sim/ray_cast.h"
#include "engine/sim/scene.h"
#include "engine/sim/sensor.h"

namespace vs::sim {

// The direction towards the only lamp, in the rig's frame.
Vec3 LampInRig();

// Writes the light of what the rays hit into light[i], wherever that is the given object
// (surface[i] == id). Objects and lamp are in the rays' frame. Lambert's law under one lamp and
// ambient light, times the surface's texture; there are no shadows.
void ShadePlane(const Plane& plane, Vec3 lamp, uint8_t id, const RayRow& row, Light* light);
void ShadeBox(const Box& box, Vec3 lamp, uint8_t id, const RayRow& row, Light* light);
void ShadeSphere(const Sphere& sphere, Vec3 lamp, uint8_t id, const RayRow& row, Light* light);

}  // namespace vs::sim
