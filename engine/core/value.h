#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include "engine/image/depth_map.h"
#include "engine/image/disparity_map.h"
#include "engine/image/frame.h"
#include "engine/image/point_cloud.h"
#include "engine/image/stereo_rig.h"

namespace vs {

class Value;

// "It happened", and when (host's monotonic clock).
struct Trigger {
  int64_t time_ns = 0;

  bool operator==(const Trigger&) const = default;
};

using List = std::vector<Value>;

// Rows of equal length under named columns.
struct Table {
  std::vector<std::string> columns;
  std::vector<List> rows;
};

// Everything that a port can carry. Small values are held directly; large ones are shared and
// immutable, so that handing a Value on costs a reference count and never a copy of pixels.
class Value {
 public:
  using Variant = std::variant<std::monostate, bool, int64_t, double, std::string, Trigger,
                               std::shared_ptr<const List>, std::shared_ptr<const Table>,
                               std::shared_ptr<const GreyImage>, std::shared_ptr<const ColorImage>,
                               std::shared_ptr<const Frame>, std::shared_ptr<const StereoFrame>,
                               std::shared_ptr<const StereoTruth>,
                               std::shared_ptr<const DisparityMap>, std::shared_ptr<const DepthMap>,
                               std::shared_ptr<const PointCloud>, std::shared_ptr<const StereoRig>>;

  Value() = default;
  // From anything that the variant holds.
  template <class T, class = std::enable_if_t<std::is_constructible_v<Variant, T&&> &&
                                              !std::is_same_v<std::decay_t<T>, Value>>>
  // NOLINTNEXTLINE(google-explicit-constructor,bugprone-forwarding-reference-overload)
  Value(T&& value) : variant_(std::forward<T>(value)) {}

  bool empty() const { return std::holds_alternative<std::monostate>(variant_); }
  const Variant& variant() const { return variant_; }

  // The value when it is held directly (bool, int64_t, double, string, Trigger), the shared object
  // otherwise; null when the Value holds something else.
  template <class T>
  const T* GetIf() const {
    if constexpr (IsHeldDirectly<T>()) {
      return std::get_if<T>(&variant_);
    } else {
      const auto* shared = std::get_if<std::shared_ptr<const T>>(&variant_);
      return shared == nullptr ? nullptr : shared->get();
    }
  }

  template <class T>
  static constexpr bool IsHeldDirectly() {
    return std::is_same_v<T, bool> || std::is_same_v<T, int64_t> || std::is_same_v<T, double> ||
           std::is_same_v<T, std::string> || std::is_same_v<T, Trigger>;
  }

 private:
  Variant variant_;
};

// The type of a port, as its name in descriptors and messages. In<Value> takes any type.
template <class T>
struct PortType;
#define VS_PORT_TYPE(Type, name)                    \
  template <>                                       \
  struct PortType<Type> {                           \
    static constexpr std::string_view kName = name; \
  }
VS_PORT_TYPE(Value, "any");
VS_PORT_TYPE(bool, "bool");
VS_PORT_TYPE(int64_t, "integer");
VS_PORT_TYPE(double, "number");
VS_PORT_TYPE(std::string, "string");
VS_PORT_TYPE(Trigger, "trigger");
VS_PORT_TYPE(List, "list");
VS_PORT_TYPE(Table, "table");
VS_PORT_TYPE(GreyImage, "grey_image");
VS_PORT_TYPE(ColorImage, "color_image");
VS_PORT_TYPE(Frame, "frame");
VS_PORT_TYPE(StereoFrame, "stereo_frame");
VS_PORT_TYPE(StereoTruth, "stereo_truth");
VS_PORT_TYPE(DisparityMap, "disparity_map");
VS_PORT_TYPE(DepthMap, "depth_map");
VS_PORT_TYPE(PointCloud, "point_cloud");
VS_PORT_TYPE(StereoRig, "stereo_rig");
#undef VS_PORT_TYPE

// The port type name of what `value` holds; "any" when it is empty.
std::string_view TypeName(const Value& value);

}  // namespace vs
