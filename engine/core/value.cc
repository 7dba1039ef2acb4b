#include "engine/core/value.h"

#include <type_traits>

namespace vs {
namespace {

template <class T>
struct Pointee {
  using Type = T;
};
template <class T>
struct Pointee<std::shared_ptr<const T>> {
  using Type = T;
};

}  // namespace

std::string_view TypeName(const Value& value) {
  return std::visit(
      [](const auto& held) -> std::string_view {
        using Held = std::decay_t<decltype(held)>;
        if constexpr (std::is_same_v<Held, std::monostate>) {
          return PortType<Value>::kName;
        } else {
          return PortType<typename Pointee<Held>::Type>::kName;
        }
      },
      value.variant());
}

}  // namespace vs
