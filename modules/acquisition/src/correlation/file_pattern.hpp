// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <filesystem>
#include <set>
#include <string>
#include <vector>

#include <tofmap/acquisition/correlation/array_layout.hpp>

namespace tofmap {

/// A file name with fields in braces, such as "{frame:06}_{frequency}.png".
class FilePattern {
 public:
  /// Throws InputError if a brace is not closed or a field is unknown. A field with names is
  /// replaced by the name of its number, another one by the number itself.
  FilePattern(std::string pattern, std::vector<std::string> frequency_names,
              std::vector<std::string> step_names);

  bool has(ArrayAxis field) const;

  /// The values of the fields. Those that the pattern does not have are ignored.
  struct Numbers {
    std::int64_t frame = 0;
    int frequency = 0;
    int step = 0;
    int image = 0;
  };

  std::filesystem::path path(const Numbers& numbers) const;

  /// The frames of which at least one file exists below `folder`.
  std::set<std::int64_t> frames_below(const std::filesystem::path& folder) const;

 private:
  /// A field and the text before it. The last piece of a pattern has no field.
  struct Piece {
    std::string text;
    bool has_field = false;
    ArrayAxis field = ArrayAxis::frame;
    int digits = 0;
  };

  const std::vector<std::string>& names_of(ArrayAxis field) const;
  std::string text_of(const Piece& piece, const Numbers& numbers) const;
  std::string regular_expression() const;

  std::vector<Piece> pieces_;
  std::vector<std::string> frequency_names_;
  std::vector<std::string> step_names_;
};

}  // namespace tofmap
