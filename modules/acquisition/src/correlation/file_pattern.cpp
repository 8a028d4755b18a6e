// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "file_pattern.hpp"

#include <algorithm>
#include <charconv>
#include <regex>
#include <system_error>

#include <fmt/format.h>

#include <tofmap/core/error.hpp>

namespace tofmap {
namespace {

constexpr ArrayAxis fields[] = {ArrayAxis::frame, ArrayAxis::frequency, ArrayAxis::step,
                                ArrayAxis::image};

/// The text as a regular expression that matches it alone.
std::string escaped(const std::string& text) {
  std::string result;
  for (const char c : text) {
    if (std::string_view("^$\\.*+?()[]{}|").find(c) != std::string_view::npos) result += '\\';
    result += c;
  }
  return result;
}

/// The files below `folder` whose path relative to it has the depth of the pattern.
void add_files(const std::filesystem::path& folder, int depth,
               std::vector<std::filesystem::path>& files) {
  std::error_code ignored;
  for (const auto& entry : std::filesystem::directory_iterator(folder, ignored)) {
    if (depth == 0) {
      files.push_back(entry.path());
    } else if (entry.is_directory(ignored)) {
      add_files(entry.path(), depth - 1, files);
    }
  }
}

}  // namespace

FilePattern::FilePattern(std::string pattern, std::vector<std::string> frequency_names,
                         std::vector<std::string> step_names)
    : frequency_names_(std::move(frequency_names)), step_names_(std::move(step_names)) {
  const auto refuse = [&](const std::string& what) {
    throw InputError("'" + pattern + "' " + what +
                     "; allowed: {frame}, {frequency}, {step} and {image}, with a number of digits "
                     "as in {frame:06}");
  };
  std::size_t begin = 0;
  while (true) {
    const std::size_t open = pattern.find('{', begin);
    pieces_.push_back({.text = pattern.substr(begin, open - begin)});
    if (pieces_.back().text.find('}') != std::string::npos) refuse("has a } without {");
    if (open == std::string::npos) return;
    const std::size_t close = pattern.find('}', open);
    if (close == std::string::npos) refuse("has a { without }");
    const std::string field = pattern.substr(open + 1, close - open - 1);
    const std::string name = field.substr(0, field.find(':'));
    const auto found = std::ranges::find(fields, name, name_of);
    if (found == std::end(fields)) refuse("has the unknown field {" + field + "}");
    Piece& piece = pieces_.back();
    piece.has_field = true;
    piece.field = *found;
    if (name.size() < field.size()) {
      std::string digits = field.substr(name.size() + 1);
      if (digits.ends_with('d')) digits.pop_back();
      const auto [end, error] =
          std::from_chars(digits.data(), digits.data() + digits.size(), piece.digits);
      if (error != std::errc() || end != digits.data() + digits.size() || piece.digits > 18) {
        refuse("has the unknown field {" + field + "}");
      }
    }
    begin = close + 1;
  }
}

bool FilePattern::has(ArrayAxis field) const {
  return std::ranges::any_of(
      pieces_, [&](const Piece& piece) { return piece.has_field && piece.field == field; });
}

const std::vector<std::string>& FilePattern::names_of(ArrayAxis field) const {
  static const std::vector<std::string> none;
  if (field == ArrayAxis::frequency) return frequency_names_;
  return field == ArrayAxis::step ? step_names_ : none;
}

std::string FilePattern::text_of(const Piece& piece, const Numbers& numbers) const {
  const std::int64_t number = piece.field == ArrayAxis::frame       ? numbers.frame
                              : piece.field == ArrayAxis::frequency ? numbers.frequency
                              : piece.field == ArrayAxis::step      ? numbers.step
                                                                    : numbers.image;
  const std::vector<std::string>& names = names_of(piece.field);
  return names.empty() ? fmt::format("{:0{}}", number, piece.digits)
                       : names.at(static_cast<std::size_t>(number));
}

std::filesystem::path FilePattern::path(const Numbers& numbers) const {
  std::string path;
  for (const Piece& piece : pieces_) {
    path += piece.text;
    if (piece.has_field) path += text_of(piece, numbers);
  }
  return path;
}

std::string FilePattern::regular_expression() const {
  std::string expression;
  bool frame_was_seen = false;
  for (const Piece& piece : pieces_) {
    expression += escaped(piece.text);
    if (!piece.has_field) continue;
    const std::vector<std::string>& names = names_of(piece.field);
    if (piece.field == ArrayAxis::frame) {
      expression += frame_was_seen ? "\\1" : "([0-9]{1,18})";
      frame_was_seen = true;
    } else if (names.empty()) {
      expression += "[0-9]+";
    } else {
      std::string alternatives;
      for (const std::string& name : names) {
        alternatives += (alternatives.empty() ? "" : "|") + escaped(name);
      }
      expression += "(?:" + alternatives + ")";
    }
  }
  return expression;
}

std::set<std::int64_t> FilePattern::frames_below(const std::filesystem::path& folder) const {
  // Files are searched below the part of the pattern that has no fields.
  const std::string start = pieces_.front().text;
  const std::size_t slash = start.rfind('/');
  const std::string base = slash == std::string::npos ? "" : start.substr(0, slash + 1);
  std::string rest;
  for (const Piece& piece : pieces_) rest += piece.text;
  const auto depth = static_cast<int>(std::ranges::count(rest.substr(base.size()), '/'));
  std::vector<std::filesystem::path> files;
  add_files(folder / base, depth, files);
  const std::regex expression(regular_expression());
  std::set<std::int64_t> frames;
  for (const std::filesystem::path& file : files) {
    const std::string name = base + file.lexically_relative(folder / base).generic_string();
    std::smatch match;
    if (!std::regex_match(name, match, expression)) continue;
    const std::int64_t number = std::stoll(match[1].str());
    const auto is_frame = [](const Piece& piece) {
      return piece.has_field && piece.field == ArrayAxis::frame;
    };
    // With other leading zeros, it is not a name that the pattern has.
    const bool is_written_so = std::ranges::all_of(pieces_, [&](const Piece& piece) {
      return !is_frame(piece) || text_of(piece, {.frame = number}) == match[1].str();
    });
    if (is_written_so) frames.insert(number);
  }
  return frames;
}

}  // namespace tofmap
