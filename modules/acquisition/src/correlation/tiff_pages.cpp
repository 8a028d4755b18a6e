// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tiff_pages.hpp"

#include <bit>
#include <cstdarg>
#include <cstdio>

#include <tiffio.h>

#include <tofmap/acquisition/png_image.hpp>
#include <tofmap/core/error.hpp>
#include <tofmap/core/input_file.hpp>

namespace tofmap {
namespace {

/// The current page of a file in which going to a page has failed.
constexpr std::int64_t nowhere = -2;

/// Keeps the message of an error. The result says that libtiff shall not print it.
int keep_message(TIFF*, void* user, const char*, const char* format, std::va_list arguments) {
  char text[256];
  std::vsnprintf(text, sizeof text, format, arguments);
  *static_cast<std::string*>(user) = text;
  return 1;
}

int ignore_message(TIFF*, void*, const char*, const char*, std::va_list) { return 1; }

struct OptionsFreer {
  void operator()(TIFFOpenOptions* options) const { TIFFOpenOptionsFree(options); }
};

TIFF* open_tiff(const std::filesystem::path& file, std::string* message) {
  const std::unique_ptr<TIFFOpenOptions, OptionsFreer> options(TIFFOpenOptionsAlloc());
  TIFFOpenOptionsSetErrorHandlerExtR(options.get(), keep_message, message);
  TIFFOpenOptionsSetWarningHandlerExtR(options.get(), ignore_message, nullptr);
  return TIFFOpenExt(file.c_str(), "rm", options.get());
}

std::uint16_t tag(TIFF* file, std::uint32_t name) {
  std::uint16_t value = 0;
  TIFFGetFieldDefaulted(file, name, &value);
  return value;
}

ElementType type_of(TIFF* file) {
  const int bits = tag(file, TIFFTAG_BITSPERSAMPLE);
  const int format = tag(file, TIFFTAG_SAMPLEFORMAT);
  const int channels = tag(file, TIFFTAG_SAMPLESPERPIXEL);
  ElementType type;
  type.bytes = bits / 8;
  type.big_endian = std::endian::native == std::endian::big;  // libtiff converts
  type.kind = format == SAMPLEFORMAT_INT      ? ElementType::Kind::signed_integer
              : format == SAMPLEFORMAT_IEEEFP ? ElementType::Kind::floating_point
                                              : ElementType::Kind::unsigned_integer;
  const bool bits_fit =
      bits == 32 || bits == 64 || (type.is_integer() && (bits == 8 || bits == 16));
  if (channels != 1 || !bits_fit || format > SAMPLEFORMAT_IEEEFP) {
    throw InputError("must hold gray images of 8, 16, 32 or 64 bits, but has " +
                     std::to_string(channels) + " channels of " + std::to_string(bits) + " bits");
  }
  if (TIFFIsTiled(file) != 0) throw InputError("is stored in tiles; save it in strips");
  return type;
}

}  // namespace

void TiffPages::Closer::operator()(tiff* file) const { TIFFClose(file); }

TiffPages::TiffPages(const std::filesystem::path& file)
    : message_(std::make_unique<std::string>()) {
  refuse_no_file(file);
  file_.reset(open_tiff(file, message_.get()));
  if (!file_) {
    throw InputError(file.string() + ": is not a complete TIFF file (" + *message_ + ")");
  }
  naming(file.string(), [&] { read_tags(); });
  pages_ = TIFFNumberOfDirectories(file_.get());
  TIFFSetDirectory(file_.get(), 0);
}

void TiffPages::read_tags() {
  std::uint32_t width = 0;
  std::uint32_t height = 0;
  TIFFGetField(file_.get(), TIFFTAG_IMAGEWIDTH, &width);
  TIFFGetField(file_.get(), TIFFTAG_IMAGELENGTH, &height);
  // Steps may be stacked in one image, which is therefore taller or wider than the camera's.
  constexpr std::uint32_t longest_side = 64 * max_image_side_px;
  if (width < 1 || height < 1 || width > longest_side || height > longest_side) {
    throw InputError("has a size of " + std::to_string(width) + " x " + std::to_string(height) +
                     " pixels");
  }
  cols_ = width;
  rows_ = height;
  type_ = type_of(file_.get());
}

void TiffPages::go_to(std::int64_t page) {
  if (page == page_) return;
  const bool found = page == page_ + 1
                         ? TIFFReadDirectory(file_.get()) != 0
                         : TIFFSetDirectory(file_.get(), static_cast<tdir_t>(page)) != 0;
  page_ = nowhere;
  if (!found) throw InputError("has no page " + std::to_string(page) + " (" + *message_ + ")");
  std::uint32_t width = 0;
  std::uint32_t height = 0;
  TIFFGetField(file_.get(), TIFFTAG_IMAGEWIDTH, &width);
  TIFFGetField(file_.get(), TIFFTAG_IMAGELENGTH, &height);
  if (width != cols_ || height != rows_ || type_of(file_.get()) != type_) {
    throw InputError("has a page " + std::to_string(page) +
                     " of another size or type than its first page");
  }
  page_ = page;
}

std::vector<std::byte> TiffPages::read(std::int64_t page) {
  go_to(page);
  const std::int64_t row_bytes = cols_ * type_.bytes;
  if (TIFFScanlineSize64(file_.get()) != static_cast<std::uint64_t>(row_bytes)) {
    throw InputError("has rows of an unexpected length");
  }
  // The size of a page is only what its header says; memory grows as rows prove to be there.
  std::vector<std::byte> bytes;
  for (std::int64_t row = 0; row < rows_; ++row) {
    bytes.resize(static_cast<std::size_t>((row + 1) * row_bytes));
    if (TIFFReadScanline(file_.get(), bytes.data() + row * row_bytes,
                         static_cast<std::uint32_t>(row)) < 0) {
      throw InputError("is truncated or damaged in page " + std::to_string(page) + " (" +
                       *message_ + ")");
    }
  }
  return bytes;
}

}  // namespace tofmap
