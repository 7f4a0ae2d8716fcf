// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#include "oort/parameters/internal/declare.hpp"

#include <algorithm>
#include <sstream>
#include <type_traits>
#include <utility>

#include "oort/geometry/errors.hpp"

namespace oort {
namespace {

std::string quoted(const std::string& text) {
  return '"' + text + '"';
}

std::string to_text(const ParameterValue& value) {
  std::ostringstream out;
  out << std::boolalpha;
  if (const auto* text = std::get_if<std::string>(&value)) {
    out << quoted(*text);
  } else {
    std::visit([&](const auto& plain) { out << plain; }, value);
  }
  return out.str();
}

std::string expectation(const ParameterEntry& entry) {
  if (std::holds_alternative<bool>(entry.default_value)) return "true or false";
  std::ostringstream out;
  if (entry.range) {
    out << (std::holds_alternative<double>(entry.default_value) ? "a number" : "an integer") << " from "
        << entry.range->min << " to " << entry.range->max << (entry.unit.empty() ? "" : " " + entry.unit);
  } else if (!entry.choices.empty()) {
    for (const std::string& choice : entry.choices)
      out << (&choice == &entry.choices.front() ? "" : " or ") << quoted(choice);
  } else {
    out << "a text that is not empty";
  }
  return out.str();
}

[[noreturn]] void refuse(const ParameterEntry& entry, const ParameterValue& value, const std::string& why) {
  throw ParameterError(entry.path + ": " + to_text(value) + " " + why + "; it takes " + expectation(entry));
}

/// The value as the type of the entry.
template <class T>
T of_type(const ParameterEntry& entry, const ParameterValue& value) {
  if (const T* same = std::get_if<T>(&value)) return *same;
  if constexpr (std::is_same_v<T, double>) {
    if (const auto* integer = std::get_if<std::int64_t>(&value)) return static_cast<double>(*integer);
  }
  refuse(entry, value, "is of the wrong type (" + type_name(value) + ")");
}

void check_text(const ParameterEntry& entry, const std::string& text) {
  const std::vector<std::string>& choices = entry.choices;
  const bool is_choice = choices.empty() || std::find(choices.begin(), choices.end(), text) != choices.end();
  if (text.empty() || !is_choice) refuse(entry, text, "is not allowed");
}

}  // namespace

DeclaredParameter& DeclaredParameter::documented(const ParameterValue& value, const char* reason) {
  entry.documented_value = value;
  entry.reason = reason;
  return *this;
}

DeclaredParameter& DeclaredParameter::own(const ParameterValue& value, const char* reason) {
  entry.own = true;
  return documented(value, reason);
}

DeclaredParameter& DeclaredParameter::no_effect() {
  entry.status = ParameterStatus::kNoEffect;
  return *this;
}

void DeclaredParameter::set(const ParameterValue& value) {
  const auto in_range = [&](auto number) {
    // Negated so that it refuses NaN as well.
    if (!(number >= entry.range->min && number <= entry.range->max)) refuse(entry, value, "is out of range");
    return number;
  };
  if (auto* flag = std::get_if<bool*>(&field)) {
    **flag = of_type<bool>(entry, value);
  } else if (auto* integer = std::get_if<int*>(&field)) {
    **integer = static_cast<int>(in_range(of_type<std::int64_t>(entry, value)));
  } else if (auto* real = std::get_if<double*>(&field)) {
    **real = in_range(of_type<double>(entry, value));
  } else {
    const std::string text = of_type<std::string>(entry, value);
    check_text(entry, text);
    *std::get<std::string*>(field) = text;
  }
}

ParameterValue DeclaredParameter::get() const {
  if (const auto* integer = std::get_if<int*>(&field)) return static_cast<std::int64_t>(**integer);
  if (const auto* flag = std::get_if<bool*>(&field)) return **flag;
  if (const auto* real = std::get_if<double*>(&field)) return **real;
  return *std::get<std::string*>(field);
}

Section Section::section(const char* name, ParameterStatus status) const {
  Section inner(rows_);
  inner.prefix_ = prefix_ + name + ".";
  inner.status_ = status;
  return inner;
}

DeclaredParameter& Section::add(const char* name, const char* meaning, ParameterEntry entry,
                                decltype(DeclaredParameter::field) field) const {
  entry.path = prefix_ + name;
  entry.meaning = meaning;
  entry.documented_value = entry.default_value;
  entry.status = status_;
  return rows_.emplace_back(DeclaredParameter{std::move(entry), field});
}

DeclaredParameter& Section::operator()(bool& field, const char* name, bool value, const char* meaning) const {
  ParameterEntry entry;
  entry.default_value = value;
  return add(name, meaning, std::move(entry), &field);
}

DeclaredParameter& Section::operator()(int& field, const char* name, const Integer& integer,
                                       const char* meaning) const {
  ParameterEntry entry;
  entry.unit = integer.unit;
  entry.default_value = std::int64_t{integer.value};
  entry.range = integer.range;
  return add(name, meaning, std::move(entry), &field);
}

DeclaredParameter& Section::operator()(double& field, const char* name, const Real& real, const char* meaning) const {
  ParameterEntry entry;
  entry.unit = real.unit;
  entry.default_value = real.value;
  entry.range = real.range;
  return add(name, meaning, std::move(entry), &field);
}

DeclaredParameter& Section::operator()(std::string& field, const char* name, const Text& text,
                                       const char* meaning) const {
  ParameterEntry entry;
  entry.default_value = std::string(text.value);
  entry.choices = text.choices;
  return add(name, meaning, std::move(entry), &field);
}

}  // namespace oort
