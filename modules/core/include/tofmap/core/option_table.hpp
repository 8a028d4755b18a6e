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
#include <utility>
#include <variant>
#include <vector>

#include <tofmap/core/named_value.hpp>

namespace tofmap {

/// Access by name to a bound option that is a value of an enumeration, or a list of such values.
struct EnumReference {
  std::function<std::string()> text;               ///< returns the current name or names
  std::function<bool(std::string_view text)> set;  ///< returns false if no value has a given name
  std::string allowed;                             ///< "a | b | c", "words from a, b, c"
};

/// A pointer to a member whose type is an enumeration with named values (named_value.hpp), or a
/// std::vector of such an enumeration, for any such enumeration. The text of a list is the names
/// of its values with blanks between them.
template <class Struct>
class EnumMember {
 public:
  template <class Enum>
  requires std::is_enum_v<Enum> EnumMember(
      Enum Struct::*member)  // NOLINT(google-explicit-constructor): used in field tables
      : bind_([member](Struct& options) {
          Enum* value = &(options.*member);
          return EnumReference{.text = [value] { return std::string(name_of(*value)); },
                               .set =
                                   [value](std::string_view name) {
                                     const std::optional<Enum> found = find_named<Enum>(name);
                                     if (found) *value = *found;
                                     return found.has_value();
                                   },
                               .allowed = all_names<Enum>(" | ")};
        }) {}

  template <class Enum>
  requires std::is_enum_v<Enum> EnumMember(
      std::vector<Enum> Struct::*member)  // NOLINT(google-explicit-constructor): as above
      : bind_([member](Struct& options) {
          std::vector<Enum>* values = &(options.*member);
          return EnumReference{.text = [values] { return joined_names<Enum>(*values, " "); },
                               .set =
                                   [values](std::string_view names) {
                                     std::optional<std::vector<Enum>> found =
                                         find_all_named<Enum>(names);
                                     if (found) *values = std::move(*found);
                                     return found.has_value();
                                   },
                               .allowed = "words from " + all_names<Enum>(", ")};
        }) {}

  /// Access to the member of `options`, which must outlive the result.
  EnumReference bind(Struct& options) const { return bind_(options); }

 private:
  std::function<EnumReference(Struct&)> bind_;
};

/// One row of the field table of an options struct: the only place that states the name, allowed
/// values, unit and meaning of an option. YAML, command line, checks, printed help and
/// documentation are derived from it.
///
/// An options struct has a function `static std::vector<OptionField<Struct>> fields();`. The member
/// initialisers of the struct are the defaults.
template <class Struct>
struct OptionField {
  std::string_view name;
  std::variant<bool Struct::*, int Struct::*, double Struct::*, std::string Struct::*,
               std::vector<double> Struct::*, EnumMember<Struct>>
      member;
  double min = -std::numeric_limits<double>::infinity();  ///< smallest allowed value of numbers
  double max = std::numeric_limits<double>::infinity();   ///< largest allowed value of numbers
  std::string_view unit;                                  ///< empty if the option has no unit
  std::string_view meaning;                               ///< one line of help
};

/// An option as text, for help and documentation.
struct OptionText {
  std::string group;    ///< empty at the top level
  std::string name;     ///< within the group
  std::string value;    ///< current value, as written in YAML
  std::string allowed;  ///< "1 … 10", "true | false", "a | b | c", "any text"
  std::string unit;     ///< empty if the option has no unit
  std::string meaning;  ///< one line of help

  /// `group.name`, or `name` at the top level: the key that OptionTable::set takes.
  std::string key() const { return group.empty() ? name : group + "." + name; }
};

/// The options of a program: fields of bound structs, addressed as `group.name`.
///
///     OptionTable table;
///     table.bind("unwrap", unwrap_options);
///     table.load("config.yaml");
///     table.set("unwrap.max_range_m", "30");
///
/// The table writes into the bound structs, which must outlive it. An unknown option or a value
/// that is not allowed throws a UsageError, which names the key, the value and what is allowed.
class OptionTable {
 public:
  /// Adds the fields of a struct as the group `group`. An empty name adds them at the top level.
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

  /// Sets the option `key`, which is `group.name`, from text. The numbers of a list are separated
  /// by commas, in brackets or without: "80e6, 16e6".
  void set(const std::string& key, const std::string& value);

  /// Sets one option from `group.name=value`, the argument of `--set`.
  void assign(const std::string& assignment);

  /// Sets all options that a YAML file names. The file is a map of groups, and each group is a map
  /// of option names. Ignores groups that only `others` has, so that commands can share a file.
  /// Throws InputError if the file cannot be read or is not a YAML map.
  void load(const std::filesystem::path& file, const OptionTable& others = {});

  /// All options as YAML that load() accepts. `with_comments` adds a comment with meaning, range
  /// and unit to each option.
  std::string to_yaml(bool with_comments) const;

  /// Whether there are options of this group; false for the empty name.
  bool has_group(const std::string& group) const;

  /// All options, in the order in which they were bound.
  std::vector<OptionText> texts() const;

 private:
  struct Entry {
    std::string group;
    std::string name;
    double min = 0;
    double max = 0;
    std::string unit;
    std::string meaning;
    std::variant<bool*, int*, double*, std::string*, std::vector<double>*, EnumReference> value;

    std::string key() const { return group.empty() ? name : group + "." + name; }
    std::string allowed() const;
    std::string text() const;
    void set(const std::string& value_text);
  };

  void add(Entry entry);
  Entry& find(const std::string& key, const std::string& value);

  std::vector<Entry> entries_;
};

}  // namespace tofmap
