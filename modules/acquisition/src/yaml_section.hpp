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

namespace tofmap {

/// A YAML map that knows where it stands, so that every complaint names file and key.
class YamlSection {
 public:
  YamlSection(const std::filesystem::path& file, std::string name, const YAML::Node& node)
      : file_(file), name_(std::move(name)), node_(node) {
    if (!node_.IsMap()) fail(name_.empty() ? "the file" : name_, "must be a map of keys");
    std::set<std::string> keys;
    for (const auto& entry : node_) {
      if (!keys.insert(entry.first.as<std::string>()).second) {
        fail(key(entry.first.as<std::string>()), "stands there twice");
      }
    }
  }

  [[noreturn]] void fail(const std::string& key, const std::string& what) const {
    throw InputError(file_.string() + ": " + key + " " + what);
  }

  std::string key(const std::string& name) const {
    return name_.empty() ? name : name_ + "." + name;
  }

  bool has(const std::string& name) const { return static_cast<bool>(node_[name]); }

  YamlSection section(const std::string& name) const {
    if (!has(name)) fail(key(name), "is missing");
    return {file_, key(name), node_[name]};
  }

  /// The maps of a list; none if there is no such key.
  std::vector<YamlSection> list(const std::string& name) const {
    std::vector<YamlSection> sections;
    if (!has(name)) return sections;
    if (!node_[name].IsSequence()) fail(key(name), "must be a list");
    for (const YAML::Node& one : node_[name]) sections.emplace_back(file_, key(name), one);
    return sections;
  }

  template <class T>
  T value(const std::string& name, const char* expected) const {
    if (!has(name)) fail(key(name), std::string("is missing; it must be ") + expected);
    return convert<T>(node_[name], key(name), expected);
  }

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

  /// A misspelt key would otherwise be silently without effect.
  void allow_only(std::initializer_list<std::string_view> names) const {
    std::string known;
    for (const std::string_view name : names) {
      known += (known.empty() ? "" : ", ") + std::string(name);
    }
    for (const auto& entry : node_) {
      const auto name = entry.first.as<std::string>();
      if (std::ranges::find(names, name) == names.end()) {
        fail(key(name), "is an unknown key; known here: " + known);
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
      // said below
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

  std::filesystem::path file_;
  std::string name_;
  YAML::Node node_;
};

/// The whole of a file. Throws InputError that names it if it cannot be read (`hint` says what to
/// do then) or is no YAML.
YamlSection load_yaml(const std::filesystem::path& file, const std::string& hint);

/// Throws InputError unless the file says that it is of this format and version.
void check_format(const YamlSection& root, const std::string& format, int version);

CameraModel read_camera(const YamlSection& section);

/// The keys of a camera, indented as below its name.
std::string camera_text(const CameraModel& camera);

/// The fewest digits that read back as the same bits.
std::string shortest(double number);

}  // namespace tofmap
