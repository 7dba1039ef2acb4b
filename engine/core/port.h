#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <utility>

#include "engine/base/check.h"
#include "engine/base/recycler.h"
#include "engine/core/value.h"

namespace vs {

class Block;

// Whether an input may stay unconnected.
enum class Need {
  kRequired,  // connected; the block does not run for a frame in which it got no value
  kOptional,  // may stay open; the block runs without it
  kSome,      // as kOptional, but at least one of the block's inputs of this kind is connected
};

struct PortInfo {
  std::string name;
  std::string doc;        // a full sentence for the user
  std::string_view type;  // PortType<T>::kName
  bool output = false;
  Need need = Need::kOptional;  // of an input
};

// Whether an output of type `from` may feed an input of type `to`: equal types, anything into
// "any", and an integer into a number.
bool PortTypesFit(std::string_view from, std::string_view to);

// A port as the scheduler sees it: a place for one value while one frame is processed.
class PortBase {
 public:
  PortBase(Block* owner, PortInfo info);
  PortBase(const PortBase&) = delete;
  PortBase& operator=(const PortBase&) = delete;

  const PortInfo& info() const { return info_; }
  // Of an input: the type of the output that feeds it; empty when it is not connected. Set while
  // the sequence is loaded, so Start() can rely on it; CheckParams() only on connected().
  std::string_view source_type() const { return source_type_; }
  bool connected() const { return !source_type_.empty(); }
  void Connect(std::string_view source_type) { source_type_ = source_type; }
  void Bind(Value value) { value_ = std::move(value); }
  Value Release() { return std::exchange(value_, Value()); }

 protected:
  ~PortBase() = default;
  const Value& value() const { return value_; }

 private:
  PortInfo info_;
  std::string_view source_type_;
  Value value_;
};

// An input, declared as a member of a block:
//   In<DisparityMap> left{this, "left", "Disparity of the left view."};
// While Run() is on, `*left` and `left->` give the value. What is read is shared with other blocks
// and clients, hence const.
template <class T>
class In final : public PortBase {
 public:
  In(Block* owner, std::string name, std::string doc, Need need = Need::kRequired)
      : PortBase(owner, {std::move(name), std::move(doc), PortType<T>::kName, false, need}) {}

  // Always true for a required input inside Run().
  bool has_value() const { return Get() != nullptr; }
  const T& operator*() const {
    const T* pointer = Get();
    VS_CHECK(pointer != nullptr);
    return *pointer;
  }
  const T* operator->() const { return &**this; }
  // The shared object itself, to hand on unchanged.
  std::shared_ptr<const T> Share() const
      requires(!Value::IsHeldDirectly<T>() && !std::is_same_v<T, Value>) {
    const auto* shared = std::get_if<std::shared_ptr<const T>>(&value().variant());
    return shared == nullptr ? nullptr : *shared;
  }

 private:
  const T* Get() const {
    if constexpr (std::is_same_v<T, Value>) {
      return value().empty() ? nullptr : &value();
    } else {
      return value().template GetIf<T>();
    }
  }
};

// An output. A block that sets nothing for a frame makes the blocks behind it skip that frame.
template <class T>
class Out final : public PortBase {
 public:
  Out(Block* owner, std::string name, std::string doc)
      : PortBase(owner, {std::move(name), std::move(doc), PortType<T>::kName, true}) {}

  // Publishes `result`; nobody may write it any more. Takes no heap memory once warm.
  void Set(T result) {
    if constexpr (Value::IsHeldDirectly<T>() || std::is_same_v<T, Value>) {
      Bind(Value(std::move(result)));
    } else {
      Bind(std::shared_ptr<const T>(std::allocate_shared<T>(memory_, std::move(result))));
    }
  }
  void Set(std::shared_ptr<const T> shared) requires(!Value::IsHeldDirectly<T>() &&
                                                     !std::is_same_v<T, Value>) {
    Bind(std::move(shared));
  }

 private:
  Recycler<T> memory_;
};

}  // namespace vs
