// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tofmap/acquisition/png_image.hpp"

#include <bit>
#include <cerrno>
#include <csetjmp>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <memory>
#include <string>
#include <system_error>
#include <vector>

#include <png.h>

#include <tofmap/core/error.hpp>
#include <tofmap/core/input_file.hpp>
#include <tofmap/core/text.hpp>

namespace tofmap {
namespace {

// libpng reports errors by longjmp, which must not cross a frame that holds C++ objects.
// Each function below that calls setjmp therefore holds plain pointers only; files, rows and
// messages live in its caller.

struct Closer {
  void operator()(std::FILE* file) const { std::fclose(file); }
};
using File = std::unique_ptr<std::FILE, Closer>;

/// The message that libpng's error callback stores before it jumps.
struct Failure {
  char message[128] = "";
};

void on_error(png_structp png, png_const_charp message) {
  auto* failure = static_cast<Failure*>(png_get_error_ptr(png));
  std::snprintf(failure->message, sizeof failure->message, "%s", message);
  longjmp(png_jmpbuf(png), 1);
}

void on_warning(png_structp, png_const_charp) {}  // modules never print

struct Reader {
  png_structp png = nullptr;
  png_infop info = nullptr;
  Failure failure;

  Reader() {
    png = png_create_read_struct(PNG_LIBPNG_VER_STRING, &failure, on_error, on_warning);
    if (png != nullptr) info = png_create_info_struct(png);
  }
  Reader(const Reader&) = delete;
  Reader& operator=(const Reader&) = delete;
  ~Reader() { png_destroy_read_struct(&png, &info, nullptr); }
};

struct Writer {
  png_structp png = nullptr;
  png_infop info = nullptr;
  Failure failure;

  Writer() {
    png = png_create_write_struct(PNG_LIBPNG_VER_STRING, &failure, on_error, on_warning);
    if (png != nullptr) info = png_create_info_struct(png);
  }
  Writer(const Writer&) = delete;
  Writer& operator=(const Writer&) = delete;
  ~Writer() { png_destroy_write_struct(&png, &info); }
};

bool read_header(Reader& reader, std::FILE* file) {
  if (setjmp(png_jmpbuf(reader.png)) != 0) return false;
  png_init_io(reader.png, file);
  png_set_user_limits(reader.png, max_image_side_px, max_image_side_px);
  png_read_info(reader.png, reader.info);
  return true;
}

bool read_rows(Reader& reader, bool swap_bytes, png_bytepp rows) {
  if (setjmp(png_jmpbuf(reader.png)) != 0) return false;
  if (swap_bytes) png_set_swap(reader.png);
  png_set_interlace_handling(reader.png);
  png_read_update_info(reader.png, reader.info);
  png_read_image(reader.png, rows);
  png_read_end(reader.png, nullptr);  // verifies the last checksum and the end of the file
  return true;
}

bool write_rows(Writer& writer, std::FILE* file, png_uint_32 width, png_uint_32 height, int bits,
                bool swap_bytes, png_bytepp rows) {
  if (setjmp(png_jmpbuf(writer.png)) != 0) return false;
  png_init_io(writer.png, file);
  png_set_IHDR(writer.png, writer.info, width, height, bits, PNG_COLOR_TYPE_GRAY,
               PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
  png_write_info(writer.png, writer.info);
  if (swap_bytes) png_set_swap(writer.png);
  png_write_image(writer.png, rows);
  png_write_end(writer.png, nullptr);
  return true;
}

/// True if the bytes of a pixel must be swapped, since PNG stores the high byte first.
template <class Pixel>
constexpr bool swaps_bytes = sizeof(Pixel) > 1 && std::endian::native == std::endian::little;

template <class Pixel>
std::vector<png_bytep> row_pointers(Pixel* pixels, Eigen::Index rows, Eigen::Index cols) {
  std::vector<png_bytep> pointers;
  for (Eigen::Index row = 0; row < rows; ++row) {
    pointers.push_back(reinterpret_cast<png_bytep>(pixels + row * cols));
  }
  return pointers;
}

std::string error_text(int number) { return std::generic_category().message(number); }

template <class Pixel>
Image<Pixel> read_png(const std::filesystem::path& path) {
  constexpr int bits = 8 * sizeof(Pixel);
  const auto fail = [&](const std::string& what) -> void {
    throw InputError(path.string() + ": " + what);
  };
  refuse_no_file(path);
  const File file(std::fopen(path.c_str(), "rb"));
  if (!file) fail("cannot be read: " + error_text(errno));

  Reader reader;
  if (reader.info == nullptr) throw std::bad_alloc();
  if (!read_header(reader, file.get())) {
    fail(std::string("is not a complete PNG image (") + reader.failure.message + ")");
  }
  const int file_bits = png_get_bit_depth(reader.png, reader.info);
  if (file_bits != bits || png_get_color_type(reader.png, reader.info) != PNG_COLOR_TYPE_GRAY) {
    const std::size_t channels = png_get_channels(reader.png, reader.info);
    fail("must be a gray PNG of " + std::to_string(bits) + " bits, but has " +
         std::to_string(file_bits) + " bits and " + counted(channels, "channel"));
  }

  Image<Pixel> image(png_get_image_height(reader.png, reader.info),
                     png_get_image_width(reader.png, reader.info));
  std::vector<png_bytep> rows = row_pointers(image.data(), image.rows(), image.cols());
  if (!read_rows(reader, swaps_bytes<Pixel>, rows.data())) {
    fail(std::string("is truncated or damaged (") + reader.failure.message + ")");
  }
  return image;
}

template <class Pixel>
void write_png_image(const std::filesystem::path& path, const Image<Pixel>& image) {
  if (image.size() == 0 || image.rows() > max_image_side_px || image.cols() > max_image_side_px) {
    throw UsageError(path.string() + ": an image of " + std::to_string(image.cols()) + " x " +
                     std::to_string(image.rows()) + " pixels cannot be written as PNG; allowed: " +
                     "1 to " + std::to_string(max_image_side_px) + " pixels per side");
  }
  const auto fail = [&](const std::string& why) -> void {
    throw InputError(path.string() + ": cannot be written: " + why);
  };
  File file(std::fopen(path.c_str(), "wb"));
  if (!file) fail(error_text(errno));

  Writer writer;
  if (writer.info == nullptr) throw std::bad_alloc();
  // libpng's interface takes mutable rows, but only reads them.
  std::vector<png_bytep> rows =
      row_pointers(const_cast<Pixel*>(image.data()), image.rows(), image.cols());
  errno = 0;
  const bool written = write_rows(writer, file.get(), static_cast<png_uint_32>(image.cols()),
                                  static_cast<png_uint_32>(image.rows()), 8 * sizeof(Pixel),
                                  swaps_bytes<Pixel>, rows.data());
  if (!written) fail(errno != 0 ? error_text(errno) : writer.failure.message);
  // Closing flushes the buffer, so a full disk may show only here.
  if (std::fclose(file.release()) != 0) fail(error_text(errno));
}

}  // namespace

ImageU16 read_png_16(const std::filesystem::path& file) { return read_png<std::uint16_t>(file); }

ImageU8 read_png_8(const std::filesystem::path& file) { return read_png<std::uint8_t>(file); }

void write_png(const std::filesystem::path& file, const ImageU16& image) {
  write_png_image(file, image);
}

void write_png(const std::filesystem::path& file, const ImageU8& image) {
  write_png_image(file, image);
}

}  // namespace tofmap
