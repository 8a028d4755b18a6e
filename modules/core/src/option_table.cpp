// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tofmap/core/option_table.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>
#include <set>
#include <sstream>
#include <string>

#include <yaml-cpp/yaml.h>

#include <tofmap/core/error.hpp>
#include <tofmap/core/input_file.hpp>
#include <tofmap/core/number_text.hpp>
#include <tofmap/core/text.hpp>

namespace tofmap {
namespace {

template <class Number>
std::optional<Number> parse_number(const std::string& text) {
  Number number{};
  const char* end = text.data() + text.size();
  const auto [rest, error] = std::from_chars(text.data(), end, number);
  if (error != std::errc() || rest != end) return std::nullopt;
  return number;
}

/// The numbers of "80e6, 16e6" or "[80e6, 16e6]"; empty if something else is among them.
std::optional<std::vector<double>> parse_numbers(std::string text) {
  if (text.starts_with('[') && text.ends_with(']')) text = text.substr(1, text.size() - 2);
  std::ranges::replace(text, ',', ' ');
  std::vector<double> numbers;
  std::istringstream words(text);
  for (std::string word; words >> word;) {
    const auto number = parse_number<double>(word);
    if (!number) return std::nullopt;
    numbers.push_back(*number);
  }
  return numbers;
}

std::optional<bool> parse_bool(const std::string& text) {
  if (text == "true") return true;
  if (text == "false") return false;
  return std::nullopt;
}

/// Text as a YAML scalar, in quotes where it needs them.
std::string yaml_text(const std::string& text) { return YAML::Dump(YAML::Node(text)); }

std::string range_text(double min, double max) {
  const bool from = std::isfinite(min);
  const bool to = std::isfinite(max);
  if (from && to) return shortest(min) + " … " + shortest(max);
  if (from) return "at least " + shortest(min);
  if (to) return "at most " + shortest(max);
  return "any number";
}

}  // namespace

std::string OptionTable::Entry::allowed() const {
  if (std::holds_alternative<bool*>(value)) return "true | false";
  if (std::holds_alternative<std::string*>(value)) return "any text";
  if (const auto* named = std::get_if<EnumReference>(&value)) return named->allowed;
  if (std::holds_alternative<std::vector<double>*>(value)) {
    return "list of numbers, " + range_text(min, max);
  }
  const bool whole = std::holds_alternative<int*>(value);
  return (whole ? "whole number, " : "") + range_text(min, max);
}

std::string OptionTable::Entry::text() const {
  if (const auto* flag = std::get_if<bool*>(&value)) return **flag ? "true" : "false";
  if (const auto* whole = std::get_if<int*>(&value)) return std::to_string(**whole);
  if (const auto* number = std::get_if<double*>(&value)) return shortest(**number);
  if (const auto* list = std::get_if<std::vector<double>*>(&value)) return list_text(**list);
  if (const auto* named = std::get_if<EnumReference>(&value)) return yaml_text(named->text());
  return yaml_text(*std::get<std::string*>(value));
}

void OptionTable::Entry::set(const std::string& value_text) {
  const auto refuse = [&] {
    throw UsageError("option " + key() + ": '" + value_text +
                     "' is not allowed; allowed: " + allowed() + (unit.empty() ? "" : " " + unit));
  };
  const auto fits = [&](double number) {
    return std::isfinite(number) && number >= min && number <= max;
  };
  if (auto* flag = std::get_if<bool*>(&value)) {
    const auto parsed = parse_bool(value_text);
    if (!parsed) refuse();
    **flag = *parsed;
  } else if (auto* whole = std::get_if<int*>(&value)) {
    const auto parsed = parse_number<int>(value_text);
    if (!parsed || *parsed < min || *parsed > max) refuse();
    **whole = *parsed;
  } else if (auto* number = std::get_if<double*>(&value)) {
    const auto parsed = parse_number<double>(value_text);
    if (!parsed || !fits(*parsed)) refuse();
    **number = *parsed;
  } else if (auto* list = std::get_if<std::vector<double>*>(&value)) {
    auto parsed = parse_numbers(value_text);
    if (!parsed || !std::ranges::all_of(*parsed, fits)) refuse();
    **list = std::move(*parsed);
  } else if (auto* named = std::get_if<EnumReference>(&value)) {
    if (!named->set(value_text)) refuse();
  } else {
    *std::get<std::string*>(value) = value_text;
  }
}

void OptionTable::add(Entry entry) { entries_.push_back(std::move(entry)); }

OptionTable::Entry& OptionTable::find(const std::string& key, const std::string& value) {
  const auto found = std::ranges::find_if(entries_, [&](const Entry& e) { return e.key() == key; });
  if (found != entries_.end()) return *found;
  // List the options of the same group; if there is no such group, list the groups.
  const std::string group = key.substr(0, key.find('.'));
  std::vector<std::string> names;
  std::vector<std::string> groups;
  for (const Entry& entry : entries_) {
    if (entry.group == group && key != group) names.push_back(entry.key());
    const std::string top = entry.group.empty() ? entry.name : entry.group;
    if (std::ranges::find(groups, top) == groups.end()) groups.push_back(top);
  }
  throw UsageError("unknown option " + key + " (value '" + value +
                   "'); known: " + joined(names.empty() ? groups : names, ", "));
}

void OptionTable::set(const std::string& key, const std::string& value) {
  find(key, value).set(value);
}

void OptionTable::assign(const std::string& assignment) {
  const std::size_t equals = assignment.find('=');
  if (equals == std::string::npos || equals == 0) {
    throw UsageError("--set " + assignment + ": expected group.name=value");
  }
  set(assignment.substr(0, equals), assignment.substr(equals + 1));
}

bool OptionTable::has_group(const std::string& group) const {
  return !group.empty() && std::ranges::find(entries_, group, &Entry::group) != entries_.end();
}

void OptionTable::load(const std::filesystem::path& file, const OptionTable& others) {
  const auto is_list = [&](const std::string& key) {
    return std::ranges::any_of(entries_, [&](const Entry& entry) {
      return entry.key() == key && std::holds_alternative<std::vector<double>*>(entry.value);
    });
  };
  const auto text_of = [&](const std::string& key, const YAML::Node& node) {
    if (node.IsScalar()) return node.Scalar();
    if (!node.IsSequence() || !is_list(key)) {
      throw UsageError(file.string() + ": option " + key + " must be a single value");
    }
    std::string text;
    for (const YAML::Node& one : node) {
      if (!one.IsScalar()) throw UsageError(file.string() + ": option " + key + " must be a list");
      text += (text.empty() ? "" : ", ") + one.Scalar();
    }
    return text;
  };
  const auto scalar = [&](const std::string& key, const YAML::Node& node) {
    const std::string text = text_of(key, node);
    try {
      set(key, text);
    } catch (const UsageError& error) {
      throw UsageError(file.string() + ":" + std::to_string(node.Mark().line + 1) + ": " +
                       error.what());
    }
  };
  refuse_no_file(file);
  YAML::Node root;
  try {
    root = YAML::LoadFile(file.string());
  } catch (const YAML::BadFile&) {
    throw InputError(file.string() + ": cannot be read; does it exist?");
  } catch (const YAML::Exception& error) {
    throw InputError(file.string() + ": is not valid YAML: " + error.what());
  }
  if (root.IsNull()) return;  // an empty file sets nothing
  if (!root.IsMap()) throw InputError(file.string() + ": expected a map of option groups");
  std::set<std::string> given;
  const auto refuse_twice = [&](const std::string& name, const YAML::Node& key) {
    if (given.insert(name).second) return;
    throw InputError(file.string() + ":" + std::to_string(key.Mark().line + 1) + ": " + name +
                     " is given twice");
  };
  for (const auto& group : root) {
    const std::string name = group.first.as<std::string>();
    refuse_twice(name, group.first);
    if (!has_group(name) && others.has_group(name)) continue;
    if (group.second.IsMap()) {
      for (const auto& option : group.second) {
        const std::string key = name + "." + option.first.as<std::string>();
        refuse_twice(key, option.first);
        scalar(key, option.second);
      }
    } else if (!group.second.IsNull() || !has_group(name)) {  // an empty group sets nothing
      scalar(name, group.second);
    }
  }
}

std::vector<OptionText> OptionTable::texts() const {
  std::vector<OptionText> texts;
  for (const Entry& entry : entries_) {
    texts.push_back(
        {entry.group, entry.name, entry.text(), entry.allowed(), entry.unit, entry.meaning});
  }
  return texts;
}

std::string OptionTable::to_yaml(bool with_comments) const {
  std::ostringstream out;
  std::string group;
  for (const Entry& entry : entries_) {
    if (entry.group != group) {
      group = entry.group;
      out << group << ":\n";
    }
    const std::string indent = group.empty() ? "" : "  ";
    if (with_comments) {
      out << indent << "# " << entry.meaning << " [" << entry.allowed()
          << (entry.unit.empty() ? "" : ", " + entry.unit) << "]\n";
    }
    out << indent << entry.name << ": " << entry.text() << '\n';
  }
  return out.str();
}

}  // namespace tofmap
