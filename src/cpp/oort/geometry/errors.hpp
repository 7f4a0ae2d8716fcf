// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <stdexcept>
#include <string>

namespace oort {

/// What is quoted from outside may be of any length and no text: of a long message the ends are told, and bytes that
/// are no UTF-8 become question marks.
std::string to_message(const std::string& text);

/// Root of the family: everything Oort throws because of its input or its environment. Each message says what is
/// wrong, where, and what to do. Reaches Python as oort.OortError and its subclasses of the same names.
class Error : public std::runtime_error {
 public:
  explicit Error(const std::string& what) : std::runtime_error(to_message(what)) {}
};

/// A parameter that is unknown, of the wrong type or out of its range.
class ParameterError : public Error {
 public:
  using Error::Error;
};

/// A map on disk that is missing, damaged or cannot be written.
class MapFileError : public Error {
 public:
  using Error::Error;
};

/// Sensor data that cannot be used: a scan without beams, a pose that is not finite.
class InputError : public Error {
 public:
  using Error::Error;
};

/// A call that the current state does not allow, or that names something unknown.
class StateError : public Error {
 public:
  using Error::Error;
};

}  // namespace oort
