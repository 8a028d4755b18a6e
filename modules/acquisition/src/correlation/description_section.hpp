// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "../yaml_section.hpp"

#include <string>
#include <utility>
#include <vector>

#include <tofmap/acquisition/correlation/correlation_description.hpp>

namespace tofmap {

/// The value that belongs to the word of a key. Throws InputError, which lists the words, if the
/// key has another one.
template <class Value>
Value word_of(const YamlSection& section, const std::string& name,
              const std::vector<std::pair<std::string, Value>>& words) {
  std::string allowed;
  for (std::size_t i = 0; i < words.size(); ++i) {
    if (i > 0) allowed += i + 1 == words.size() ? " or " : ", ";
    allowed += words[i].first;
  }
  const auto given = section.value<std::string>(name, allowed.c_str());
  for (const auto& [word, value] : words) {
    if (word == given) return value;
  }
  section.fail(section.key(name), "must be " + allowed + ", not '" + given + "'");
}

/// Throws InputError unless the number of values is `wanted`, the number of `of_what`.
void check_count(const YamlSection& section, const std::string& name, std::size_t given,
                 std::size_t wanted, const std::string& of_what);

/// Reads array files from a section with the keys files, axes and so on. `sizes` are the expected
/// ones. Steps must be a field or an axis only if `sizes` has several; the same for frequencies.
/// Checks that each axis is given once and that `images` names each image once.
ArrayFiles read_array_files(const YamlSection& section, const ArraySizes& sizes);

/// Reads `values`: bits, companding and saturation.
StepValues read_step_values(const YamlSection& section);

/// Reads `dark`. `sizes` are those of frames.
DarkLevel read_dark(const YamlSection& section, const ArraySizes& sizes);

/// Reads `phase_offsets`. `sizes` are those of frames.
PhaseOffsets read_phase_offsets(const YamlSection& section, ArraySizes sizes,
                                const std::vector<double>& frequencies_hz);

/// Reads `timestamps`.
FrameTimes read_frame_times(const YamlSection& section, const std::filesystem::path& folder);

}  // namespace tofmap
