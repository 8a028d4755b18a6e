// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <variant>
#include <vector>

#include <tofmap/core/named_value.hpp>

namespace tofmap {

/// A bound option whose value is one of an enumeration.
struct EnumReference {
  std::function<std::string_view()> name;          ///< of the present value
  std::function<bool(std::string_view name)> set;  ///< false if no value has that name
  std::string choices;                             ///< "a | b | c"
};

/// A member of a struct whose type is an enumeration with named values (named_value.hpp).
template <class Struct>
class EnumMember {
 public:
  template <class Enum>
  requires std::is_enum_v<Enum> EnumMember(
      Enum Struct::*member)  // NOLINT(google-explicit-constructor): stands in field tables
      : bind_([member](Struct& options) {
          Enum* value = &(options.*member);
          return EnumReference{.name = [value] { return name_of(*value); },
                               .set =
                                   [value](std::string_view name) {
                                     const std::optional<Enum> found = find_named<Enum>(name);
                                     if (found) *value = *found;
                                     return found.has_value();
                                   },
                               .choices = all_names<Enum>(" | ")};
        }) {}

  EnumReference bind(Struct& options) const { return bind_(options); }

 private:
  std::function<EnumReference(Struct&)> bind_;
};

/// One row of an options struct's field table: the single place where the name, allowed
/// values, unit and meaning of an option are written. YAML, command line, checks, printed
/// help and documentation are all derived from it.
///
/// A stage's struct offers `static std::vector<OptionField<Struct>> fields();`. Defaults are
/// those of the struct's member initialisers.
template <class Struct>
struct OptionField {
  std::string_view name;
  std::variant<bool Struct::*, int Struct::*, double Struct::*, std::string Struct::*,
               EnumMember<Struct>>
      member;
  double min = -std::numeric_limits<double>::infinity();  ///< numbers only
  double max = std::numeric_limits<double>::infinity();   ///< numbers only
  std::string_view unit;                                  ///< empty if it has none
  std::string_view meaning;
  std::string_view choices{};  ///< strings only: "a | b | c"; empty: any text
};

/// An option in words.
struct OptionText {
  std::string group;  ///< empty at the top level
  std::string name;
  std::string value;    ///< as YAML has it
  std::string allowed;  ///< "1 … 10", "true | false", "a | b | c", "any text"
  std::string unit;     ///< empty if it has none
  std::string meaning;

  /// As `set` takes it.
  std::string key() const { return group.empty() ? name : group + "." + name; }
};

/// The options of a program: bound structs, addressed as `group.name`.
///
///     OptionTable table;
///     table.bind("unwrap", unwrap_options);
///     table.load("config.yaml");
///     table.set("unwrap.max_range_m", "30");
///
/// The table writes into the bound structs, which must outlive it. Every failure is a
/// UsageError that names the key, the value and what is allowed.
class OptionTable {
 public:
  /// Adds a struct's fields under `group`; with an empty group, at the top level.
  template <class Struct>
  void bind(const std::string& group, Struct& options) {
    for (const OptionField<Struct>& field : Struct::fields()) {
      Entry entry;
      entry.group = group;
      entry.name = field.name;
      entry.min = field.min;
      entry.max = field.max;
      entry.unit = field.unit;
      entry.meaning = field.meaning;
      entry.choices = field.choices;
      std::visit(
          [&](const auto& member) {
            if constexpr (std::is_member_pointer_v<std::decay_t<decltype(member)>>) {
              entry.value = &(options.*member);
            } else {
              entry.value = member.bind(options);
            }
          },
          field.member);
      add(std::move(entry));
    }
  }

  /// Sets one option from text.
  void set(const std::string& key, const std::string& value);

  /// Sets one option from `group.name=value`, the form of `--set`.
  void assign(const std::string& assignment);

  /// Sets all options that a YAML file names: a map of groups, each a map of names. Groups that
  /// only `others` has are passed over, so that commands can share a file.
  /// Throws InputError if the file cannot be read or is no YAML map.
  void load(const std::filesystem::path& file, const OptionTable& others = {});

  /// All options as YAML that `load` takes; with comments of unit, range and meaning on wish.
  std::string to_yaml(bool with_comments) const;

  /// All options in their order.
  std::vector<OptionText> texts() const;

 private:
  struct Entry {
    std::string group;
    std::string name;
    double min = 0;
    double max = 0;
    std::string unit;
    std::string meaning;
    std::string choices;
    std::variant<bool*, int*, double*, std::string*, EnumReference> value;

    std::string key() const { return group.empty() ? name : group + "." + name; }
    std::string allowed() const;
    std::string text() const;
    void set(const std::string& value_text);
  };

  void add(Entry entry);
  bool has_group(const std::string& group) const;
  Entry& find(const std::string& key, const std::string& value);

  std::vector<Entry> entries_;
};

}  // namespace tofmap
