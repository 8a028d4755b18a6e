// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "zip_member.hpp"

#include <algorithm>
#include <vector>

#include <zip.h>

#include <tofmap/core/error.hpp>
#include <tofmap/core/input_file.hpp>

namespace tofmap {
namespace {

std::string message_of(int code) {
  zip_error_t error;
  zip_error_init_with_code(&error, code);
  std::string message = zip_error_strerror(&error);
  zip_error_fini(&error);
  return message;
}

std::vector<std::string> array_names(zip_t* archive) {
  std::vector<std::string> names;
  for (zip_int64_t i = 0; i < zip_get_num_entries(archive, 0); ++i) {
    const char* name = zip_get_name(archive, static_cast<zip_uint64_t>(i), ZIP_FL_ENC_RAW);
    if (name != nullptr && std::string(name).ends_with(".npy")) names.emplace_back(name);
  }
  return names;
}

/// The names as "a, b and c", without ".npy".
std::string listed(const std::vector<std::string>& names) {
  std::string text;
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (i > 0) text += i + 1 == names.size() ? " and " : ", ";
    text += names[i].substr(0, names[i].size() - 4);
  }
  return text.empty() ? "no array" : text;
}

}  // namespace

void ZipMember::Closer::operator()(zip* archive) const { zip_discard(archive); }
void ZipMember::Closer::operator()(zip_file* member) const { zip_fclose(member); }

ZipMember::ZipMember(const std::filesystem::path& file, const std::string& name) {
  refuse_no_file(file);
  int error = 0;
  archive_.reset(zip_open(file.c_str(), ZIP_RDONLY, &error));
  if (!archive_) {
    throw InputError(file.string() + ": is not a complete .npz file (" + message_of(error) + ")");
  }
  const std::vector<std::string> names = array_names(archive_.get());
  if (name.empty() && names.size() != 1) {
    throw InputError(file.string() + ": holds " + listed(names) +
                     "; name one array of it as 'member'");
  }
  const std::string wanted = name.empty()             ? names.front()
                             : name.ends_with(".npy") ? name
                                                      : name + ".npy";
  const auto found = std::ranges::find(names, wanted);
  if (found == names.end()) {
    throw InputError(file.string() + ": has no member '" + name + "'; it holds " + listed(names));
  }
  index_ = static_cast<std::uint64_t>(
      std::max<zip_int64_t>(0, zip_name_locate(archive_.get(), wanted.c_str(), ZIP_FL_ENC_RAW)));
  zip_stat_t status;
  zip_stat_init(&status);
  const bool has_size = zip_stat_index(archive_.get(), index_, 0, &status) == 0 &&
                        (status.valid & ZIP_STAT_SIZE) != 0;
  if (has_size) size_ = static_cast<std::int64_t>(status.size);
  naming(file.string(), [&] { rewind(); });
}

void ZipMember::rewind() {
  member_.reset();
  member_.reset(zip_fopen_index(archive_.get(), index_, 0));
  position_ = 0;
  if (!member_) {
    throw InputError(std::string("is a damaged .npz file (") + zip_strerror(archive_.get()) + ")");
  }
}

void ZipMember::fill(std::span<std::byte> to) {
  while (!to.empty()) {
    const zip_int64_t count = zip_fread(member_.get(), to.data(), to.size());
    if (count <= 0) {
      const std::string why = count < 0 ? zip_file_strerror(member_.get()) : "it ends too early";
      throw InputError("is a damaged .npz file (" + why + ")");
    }
    position_ += count;
    to = to.subspan(static_cast<std::size_t>(count));
  }
}

void ZipMember::skip_to(std::int64_t first) {
  if (first == position_) return;
  // Stored members can be read from anywhere, deflated ones cannot.
  if (zip_fseek(member_.get(), first, SEEK_SET) == 0) {
    position_ = first;
    return;
  }
  zip_file_error_clear(member_.get());
  if (first < position_) rewind();
  std::vector<std::byte> skipped(1 << 16);
  while (position_ < first) {
    const auto rest = static_cast<std::size_t>(first - position_);
    fill(std::span(skipped).first(std::min(rest, skipped.size())));
  }
}

void ZipMember::read(std::int64_t first, std::span<std::byte> to) {
  skip_to(first);
  fill(to);
  if (position_ < size_) return;
  std::byte beyond;  // libzip checks the sum of a member when its end is read
  if (zip_fread(member_.get(), &beyond, 1) < 0) {
    throw InputError(std::string("is a damaged .npz file (") + zip_file_strerror(member_.get()) +
                     ")");
  }
}

}  // namespace tofmap
