// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <initializer_list>
#include <set>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include <yaml-cpp/yaml.h>

#include <tofmap/core/camera.hpp>
#include <tofmap/core/error.hpp>
#include <tofmap/core/number_text.hpp>

namespace tofmap {

/// A YAML map that knows its file and key, so that every error message can name them. All functions
/// throw InputError if the file does not have the expected form.
class YamlSection {
 public:
  YamlSection(const std::filesystem::path& file, std::string name, const YAML::Node& node)
      : file_(file), name_(std::move(name)), node_(node) {
    if (!node_.IsMap()) fail(name_.empty() ? "the file" : name_, "must be a map of keys");
    std::set<std::string> keys;
    for (const auto& entry : node_) {
      if (!entry.first.IsScalar()) {
        fail(name_.empty() ? "the file" : name_, "must have words as keys, not lists or maps");
      }
      if (!keys.insert(entry.first.as<std::string>()).second) {
        fail(key(entry.first.as<std::string>()), "is given twice");
      }
    }
  }

  const std::filesystem::path& file() const { return file_; }

  /// Throws InputError with the file, `key` and `what`.
  [[noreturn]] void fail(const std::string& key, const std::string& what) const {
    throw InputError(file_.string() + ": " + key + " " + what);
  }

  /// The full name of a key of this map, as "camera.width".
  std::string key(const std::string& name) const {
    return name_.empty() ? name : name_ + "." + name;
  }

  bool has(const std::string& name) const { return static_cast<bool>(node_[name]); }

  /// True if the value of a key is a list.
  bool has_list(const std::string& name) const { return has(name) && node_[name].IsSequence(); }

  /// True if the value of a key is a list of lists.
  bool has_nested_list(const std::string& name) const {
    return has_list(name) && node_[name].size() > 0 && node_[name][0].IsSequence();
  }

  YamlSection section(const std::string& name) const {
    if (!has(name)) fail(key(name), "is missing");
    return {file_, key(name), node_[name]};
  }

  /// The maps of a list. Empty if the key is missing.
  std::vector<YamlSection> list(const std::string& name) const {
    std::vector<YamlSection> sections;
    if (!has(name)) return sections;
    if (!node_[name].IsSequence()) fail(key(name), "must be a list");
    for (const YAML::Node& one : node_[name]) sections.emplace_back(file_, key(name), one);
    return sections;
  }

  /// The value of a key. `expected` completes the message "must be …".
  template <class T>
  T value(const std::string& name, const char* expected) const {
    if (!has(name)) fail(key(name), std::string("is missing; it must be ") + expected);
    return convert<T>(node_[name], key(name), expected);
  }

  /// The n values of a list. `expected` completes the message "must be …".
  template <class T, std::size_t n>
  std::array<T, n> values(const std::string& name, const char* expected) const {
    const YAML::Node list = node_[name];
    if (!list.IsSequence() || list.size() != n) {
      fail(key(name), std::string("must be ") + expected);
    }
    std::array<T, n> result{};
    for (std::size_t i = 0; i < n; ++i) result[i] = convert<T>(list[i], key(name), expected);
    return result;
  }

  /// Throws InputError if the map has other keys: a misspelt key would otherwise be ignored
  /// silently.
  void allow_only(std::initializer_list<std::string_view> names) const {
    std::string known;
    for (const std::string_view name : names) {
      known += (known.empty() ? "" : ", ") + std::string(name);
    }
    for (const auto& entry : node_) {
      const auto name = entry.first.as<std::string>();
      if (std::ranges::find(names, name) == names.end()) {
        fail(key(name), "is an unknown key; known keys: " + known);
      }
    }
  }

 private:
  template <class T>
  T convert(const YAML::Node& node, const std::string& name, const char* expected) const {
    const std::string given = node.IsScalar() ? ", not '" + node.Scalar() + "'" : "";
    try {
      T value = node.as<T>();
      if (is_finite(value)) return value;
    } catch (const YAML::Exception&) {
      // reported below
    }
    fail(name, std::string("must be ") + expected + given);
  }

  template <class T>
  static bool is_finite(const T& value) {
    if constexpr (std::is_floating_point_v<T>) return std::isfinite(value);
    return true;
  }
  static bool is_finite(const std::vector<double>& values) {
    return std::ranges::all_of(values, [](double value) { return std::isfinite(value); });
  }
  static bool is_finite(const std::vector<std::vector<double>>& lists) {
    return std::ranges::all_of(lists, [](const auto& values) { return is_finite(values); });
  }

  std::filesystem::path file_;
  std::string name_;
  YAML::Node node_;
};

/// Reads a YAML file. Throws InputError, which names the file, if the file cannot be read or is not
/// a YAML map. `hint` ends the message about a file that cannot be read.
YamlSection load_yaml(const std::filesystem::path& file, const std::string& hint);

/// The value of the key `version`. Throws InputError unless the key `format` has this value and
/// `version` is 1 … latest_version.
int check_format(const YamlSection& root, const std::string& format, int latest_version);

/// Reads the keys of a camera. Does not check that the camera is plausible; validate() does.
CameraModel read_camera(const YamlSection& section);

/// The lines of a YAML map with the keys of a camera, indented by two spaces.
std::string camera_text(const CameraModel& camera);

}  // namespace tofmap
