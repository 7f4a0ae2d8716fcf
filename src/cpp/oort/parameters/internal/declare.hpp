// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <variant>
#include <vector>

#include "oort/parameters/parameters.hpp"
#include "oort/parameters/table.hpp"

/// The words in which declare_*.cpp declare the table. To add a parameter: a field in parameters.hpp and one line in
/// the section's declare function. To change a default: the value in that line, and documented(old value, reason).
namespace oort {

struct Integer {
  int value;
  const char* unit;
  Range range;
};

struct Real {
  double value;
  const char* unit;
  Range range;
};

/// Without choices, any text but the empty one.
struct Text {
  const char* value;
  std::vector<std::string> choices = {};
};

/// A row bound to the field that holds its value.
struct DeclaredParameter {
  ParameterEntry entry;
  std::variant<bool*, int*, double*, std::string*> field;

  /// The default differs from the documented value.
  DeclaredParameter& documented(const ParameterValue& value, const char* reason);
  /// Not a documented key; `value` gives the documented behaviour. The reason is for a default that differs from it.
  DeclaredParameter& own(const ParameterValue& value, const char* reason = "");
  DeclaredParameter& no_effect();  ///< kept for the original's files

  /// Checks and stores. Throws ParameterError.
  void set(const ParameterValue& value);
  ParameterValue get() const;
};

/// Declares the parameters of one section of params.json.
class Section {
 public:
  /// `rows` must outlive the section.
  explicit Section(std::vector<DeclaredParameter>& rows) : rows_(rows) {}

  /// The section of this name inside this one; its rows get the status.
  Section section(const char* name, ParameterStatus status) const;
  Section section(const char* name) const { return section(name, status_); }

  DeclaredParameter& operator()(bool& field, const char* name, bool value, const char* meaning) const;
  DeclaredParameter& operator()(int& field, const char* name, const Integer& integer, const char* meaning) const;
  DeclaredParameter& operator()(double& field, const char* name, const Real& real, const char* meaning) const;
  DeclaredParameter& operator()(std::string& field, const char* name, const Text& text, const char* meaning) const;

 private:
  DeclaredParameter& add(const char* name, const char* meaning, ParameterEntry entry,
                         decltype(DeclaredParameter::field) field) const;

  std::vector<DeclaredParameter>& rows_;
  std::string prefix_;
  ParameterStatus status_ = ParameterStatus::kUsed;
};

void declare_general(const Section& section, Parameters& p);
void declare_output_map(const Section& section, OutputMapParameters& p);
void declare_incremental(const Section& section, IncrementalGraphBuilderParameters& p);
void declare_cartographer_matcher(const Section& section, CartographerMatcherParameters& p);
void declare_loop_closure(const Section& section, LoopClosureGraphBuilderParameters& p);
void declare_branch_and_bound_matcher(const Section& section, BranchAndBoundMatcherParameters& p);
void declare_dock(const Section& section, DockGraphBuilderParameters& p);
void declare_localization(const Section& section, LocalizationParameters& p);

/// The three keys that every probability grid has beside its resolution.
void declare_grid_probabilities(const Section& section, ProbabilityGridParameters& p, bool insert_free_space);

/// The last two of them.
void declare_hit_and_miss(const Section& section, ProbabilityGridParameters& p);

}  // namespace oort
