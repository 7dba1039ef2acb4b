#pragma once

#include <arv.h>

#include <string>
#include <utility>

#include "engine/base/status.h"

namespace vs {

// Owns one reference of a GObject.
template <class T>
class GObjectPtr {
 public:
  GObjectPtr() = default;
  explicit GObjectPtr(T* object) : object_(object) {}
  GObjectPtr(GObjectPtr&& other) noexcept : object_(std::exchange(other.object_, nullptr)) {}
  GObjectPtr& operator=(GObjectPtr&& other) noexcept {
    std::swap(object_, other.object_);
    return *this;
  }
  ~GObjectPtr() { g_clear_object(&object_); }

  T* get() const { return object_; }
  void reset() { g_clear_object(&object_); }
  explicit operator bool() const { return object_ != nullptr; }

 private:
  T* object_ = nullptr;
};

// Receives the error of one GLib call (a fresh one each time): f(..., GlibError(error)).
class GlibError {
 public:
  GlibError() = default;
  GlibError(const GlibError&) = delete;
  GlibError& operator=(const GlibError&) = delete;
  ~GlibError() { g_clear_error(&error_); }

  GError** out() {
    g_clear_error(&error_);
    return &error_;
  }
  explicit operator bool() const { return error_ != nullptr; }
  // What the error means to the caller: UNAVAILABLE when the camera did not answer,
  // FAILED_PRECONDITION when it refuses at the moment, INVALID_ARGUMENT for the rest.
  Status ToStatus() const;

 private:
  GError* error_ = nullptr;
};

}  // namespace vs
