// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <pybind11/pybind11.h>

#include <mutex>
#include <utility>

namespace oort {

/// An object of the engine that Python may share between threads: its calls are made one after the other.
template <typename Object>
class Guarded {
 public:
  template <typename... Args>
  explicit Guarded(Args&&... args) : object_(std::forward<Args>(args)...) {}

  /// What a call gives that touches Python objects.
  template <typename Call>
  decltype(auto) with(Call&& call) {
    const std::unique_lock<std::mutex> lock = taken();
    return call(object_);
  }

  /// What a long call gives that touches none: other threads of Python go on meanwhile.
  template <typename Call>
  decltype(auto) aside(Call&& call) {
    const pybind11::gil_scoped_release release;
    const std::lock_guard<std::mutex> lock(mutex_);
    return call(object_);
  }

 private:
  /// Nobody waits for the object while holding Python's own lock, so that whoever has the object gets that.
  std::unique_lock<std::mutex> taken() {
    std::unique_lock<std::mutex> lock(mutex_, std::try_to_lock);
    if (!lock) {
      const pybind11::gil_scoped_release release;
      lock.lock();
    }
    return lock;
  }

  std::mutex mutex_;
  Object object_;
};

/// A method of the engine as one of the guarded object.
template <typename Object, typename Result, typename... Args>
auto guarded(Result (Object::*method)(Args...)) {
  return [method](Guarded<Object>& guard, Args... args) -> Result {
    return guard.aside([&](Object& object) { return (object.*method)(std::forward<Args>(args)...); });
  };
}
template <typename Object, typename Result, typename... Args>
auto guarded(Result (Object::*method)(Args...) const) {
  return [method](Guarded<Object>& guard, Args... args) -> Result {
    return guard.aside([&](const Object& object) { return (object.*method)(std::forward<Args>(args)...); });
  };
}

}  // namespace oort
