// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include <tofmap/acquisition/correlation/element_type.hpp>

namespace tofmap {

/// The header of a .npy file (NEP 1 of numpy, format versions 1 to 3).
struct NpyHeader {
  ElementType type;
  std::vector<std::int64_t> shape;  ///< as numpy prints it
  bool fortran_order = false;       ///< the first index is the one that varies fastest
  std::int64_t data_offset = 0;     ///< bytes before the first element
};

/// Reads the header. `read` delivers the next bytes of the file, fewer only at its end. Throws
/// InputError, without the name of the file, if the header is damaged, of another version, or of
/// a type other than integers and floating-point numbers of 1 to 8 bytes.
NpyHeader read_npy_header(const std::function<std::string(std::size_t bytes)>& read);

}  // namespace tofmap
