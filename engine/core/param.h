#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include "engine/base/status.h"

namespace vs {

class Block;

using ParamValue = std::variant<bool, int64_t, double, std::string>;

// "true", "12", "0.5" or "text", for messages.
std::string ToString(const ParamValue& value);

// Everything that an editor, a form or a validator needs to know about a parameter.
struct ParamInfo {
  std::string name;
  std::string doc;   // a full sentence for the user
  std::string unit;  // "px", "m", "ms" ...; empty for plain numbers
  ParamValue initial;
  std::optional<double> min;
  std::optional<double> max;
  std::vector<std::string> choices;  // of a string; empty = any text
  bool operator_editable = false;    // an operator may change it, not only an engineer
  bool live = true;                  // false: may change only while the sequence is stopped
};

// A block's parameter as the rest of the system sees it.
class ParamBase {
 public:
  ParamBase(Block* owner, ParamInfo info);
  virtual ~ParamBase() = default;
  ParamBase(const ParamBase&) = delete;
  ParamBase& operator=(const ParamBase&) = delete;

  const ParamInfo& info() const { return info_; }
  // INVALID_ARGUMENT or OUT_OF_RANGE with the range and unit when `value` cannot be set. An integer
  // is accepted for a number; a text has at most 4096 bytes and no control characters but newline.
  Status Check(const ParamValue& value) const;
  // The value as the block holds it: an integer given for a number becomes that number.
  ParamValue AsHeld(const ParamValue& value) const;
  virtual ParamValue Get() const = 0;
  // Changes the value at once. Only between two runs of the block; the scheduler sees to that.
  Status Set(const ParamValue& value);

 private:
  // Both get a value of the right type and range.
  virtual Status CheckFurther(const ParamValue& value) const = 0;
  virtual void Assign(const ParamValue& checked) = 0;

  ParamInfo info_;
};

template <class T>
struct ParamOptions {
  T initial{};
  std::optional<T> min;
  std::optional<T> max;
  std::string unit;
  std::vector<std::string> choices;
  bool operator_editable = false;
  bool live = true;
  std::string doc;
  // Refuses values of the right type and range that make no sense all the same: a malformed name
  // or formula. Of the value alone, so that a sequence can be checked before it runs.
  std::function<Status(const T&)> check;
};

// A parameter declared as a member of a block; T is bool, int, double or std::string. A change
// lands between two frames, so Run() reads it without a lock: `*max_difference_px`.
template <class T>
class Param final : public ParamBase {
  static_assert(std::is_same_v<T, bool> || std::is_same_v<T, int> || std::is_same_v<T, double> ||
                std::is_same_v<T, std::string>);
  using Stored = std::conditional_t<std::is_same_v<T, int>, int64_t, T>;

 public:
  Param(Block* owner, std::string name, ParamOptions<T> options)
      : ParamBase(owner, Describe(std::move(name), options)),
        check_(std::move(options.check)),
        value_(std::move(options.initial)) {}

  const T& operator*() const { return value_; }
  const T* operator->() const { return &value_; }
  ParamValue Get() const override { return static_cast<Stored>(value_); }

 private:
  static ParamInfo Describe(std::string name, const ParamOptions<T>& options) {
    ParamInfo info;
    info.name = std::move(name);
    info.doc = options.doc;
    info.unit = options.unit;
    info.initial = static_cast<Stored>(options.initial);
    if constexpr (std::is_arithmetic_v<T>) {
      if (options.min) info.min = static_cast<double>(*options.min);
      if (options.max) info.max = static_cast<double>(*options.max);
    }
    info.choices = options.choices;
    info.operator_editable = options.operator_editable;
    info.live = options.live;
    return info;
  }

  Status CheckFurther(const ParamValue& value) const override {
    return check_ ? check_(Held(value)) : Status();
  }
  void Assign(const ParamValue& checked) override { value_ = Held(checked); }

  static T Held(const ParamValue& value) {
    if constexpr (std::is_same_v<T, double>) {
      const auto* integer = std::get_if<int64_t>(&value);
      return integer != nullptr ? static_cast<double>(*integer) : std::get<double>(value);
    } else {
      return static_cast<T>(std::get<Stored>(value));
    }
  }

  std::function<Status(const T&)> check_;
  T value_;
};

}  // namespace vs
