#pragma once

#include <string_view>

namespace vs::sim {

// camera.xml: what the simulated camera tells clients about its features (GenICam GenApi 1.0).
extern const std::string_view kCameraXml;

}  // namespace vs::sim
