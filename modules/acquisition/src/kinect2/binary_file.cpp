// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "binary_file.hpp"

#include <fstream>
#include <string>
#include <system_error>

#include <tofmap/core/error.hpp>
#include <tofmap/core/input_file.hpp>

namespace tofmap::kinect2 {

std::vector<std::uint8_t> read_bytes(const std::filesystem::path& file, std::size_t most) {
  refuse_no_file(file);
  std::error_code error;
  const std::uintmax_t size = std::filesystem::file_size(file, error);
  if (error) throw InputError(file.string() + ": cannot be read: " + error.message());
  std::vector<std::uint8_t> bytes(size > most ? most + 1 : static_cast<std::size_t>(size));
  std::ifstream in(file, std::ios::binary);
  in.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
  if (!in) {
    throw InputError(file.string() +
                     ": cannot be read to its end; is it still being written, or is permission "
                     "missing?");
  }
  return bytes;
}

void write_whole(const std::filesystem::path& file, std::span<const std::uint8_t> bytes) {
  const std::filesystem::path part = file.string() + ".part";
  std::ofstream out(part, std::ios::binary);
  out.write(reinterpret_cast<const char*>(bytes.data()),
            static_cast<std::streamsize>(bytes.size()));
  out.close();
  std::error_code error;
  if (out) std::filesystem::rename(part, file, error);
  if (!out || error) {
    std::error_code ignored;
    std::filesystem::remove(part, ignored);
    throw InputError(file.string() +
                     ": cannot be written; is the disk full, or is permission missing?");
  }
}

}  // namespace tofmap::kinect2
