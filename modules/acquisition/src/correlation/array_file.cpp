// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tofmap/acquisition/correlation/array_file.hpp"

#include "npy_header.hpp"
#include "plain_file.hpp"
#include "sizes.hpp"
#include "tiff_pages.hpp"
#include "zip_member.hpp"

#include <algorithm>
#include <bit>
#include <span>
#include <utility>
#include <variant>

#include <tofmap/acquisition/png_image.hpp>
#include <tofmap/core/error.hpp>
#include <tofmap/core/input_file.hpp>

namespace tofmap {
namespace {

/// The pages of an image file as one run of bytes. Keeps the page that was read last.
class PagedBytes {
 public:
  explicit PagedBytes(const ImageU16& image)
      : page_(reinterpret_cast<const std::byte*>(image.data()),
              reinterpret_cast<const std::byte*>(image.data() + image.size())),
        page_bytes_(static_cast<std::int64_t>(page_.size())),
        index_(0) {}
  explicit PagedBytes(TiffPages pages)
      : pages_(std::move(pages)),
        page_bytes_(pages_->rows() * pages_->cols() * pages_->type().bytes) {}

  void read(std::int64_t first, std::span<std::byte> to) {
    while (!to.empty()) {
      load(first / page_bytes_);
      const std::int64_t begin = first % page_bytes_;
      const auto count = std::min(to.size(), static_cast<std::size_t>(page_bytes_ - begin));
      std::copy_n(page_.begin() + begin, count, to.begin());
      first += static_cast<std::int64_t>(count);
      to = to.subspan(count);
    }
  }

 private:
  void load(std::int64_t index) {
    if (index == index_) return;
    index_ = -1;
    page_ = pages_->read(index);
    index_ = index;
  }

  std::optional<TiffPages> pages_;  ///< empty if the only page has been read
  std::vector<std::byte> page_;
  std::int64_t page_bytes_ = 0;
  std::int64_t index_ = -1;  ///< of the page in page_, −1: none
};

}  // namespace

struct ArrayContent {
  std::filesystem::path path;
  std::variant<PlainFile, ZipMember, PagedBytes> bytes;
  ElementType type = {};
  ArrayFile::Shape shape = ArrayFile::Shape::exact;
  std::vector<std::int64_t> sizes = {};
  bool fortran_order = false;
  std::int64_t data_offset = 0;
  std::int64_t present = 0;

  void read(std::int64_t first, std::span<std::byte> to) {
    std::visit([&](auto& source) { source.read(first, to); }, bytes);
  }
};

namespace {

/// Reads the header of an array of numpy at the beginning of `content.bytes`, which have this size.
void read_header(ArrayContent& content, std::int64_t bytes) {
  std::int64_t position = 0;
  const NpyHeader header = read_npy_header([&](std::size_t count) {
    std::string text(std::min(count, static_cast<std::size_t>(bytes - position)), '\0');
    content.read(position, std::as_writable_bytes(std::span(text)));
    position += static_cast<std::int64_t>(text.size());
    return text;
  });
  content.type = header.type;
  content.sizes = header.shape;
  content.fortran_order = header.fortran_order;
  content.data_offset = header.data_offset;
  const std::int64_t data_bytes = bytes - header.data_offset;
  const std::int64_t promised = product(header.shape);
  content.present = std::min(promised, data_bytes / header.type.bytes);
  if (data_bytes > promised * header.type.bytes) {
    throw InputError("holds " + std::to_string(data_bytes) +
                     " bytes of data, but its header promises " +
                     std::to_string(promised * header.type.bytes));
  }
}

template <class Bytes>
ArrayContent open_numpy(const std::filesystem::path& file, Bytes bytes) {
  const std::int64_t size = bytes.size();
  ArrayContent content{.path = file, .bytes = std::move(bytes)};
  naming(file.string(), [&] { read_header(content, size); });
  return content;
}

ArrayContent open_pages(const std::filesystem::path& file, PagedBytes bytes,
                        const ElementType& type, std::vector<std::int64_t> sizes) {
  ArrayContent content{.path = file, .bytes = std::move(bytes), .type = type};
  content.shape = ArrayFile::Shape::pages;
  content.sizes = std::move(sizes);
  content.present = product(content.sizes);
  return content;
}

ArrayContent open_tiff(const std::filesystem::path& file) {
  TiffPages pages(file);
  const ElementType type = pages.type();
  std::vector<std::int64_t> sizes = {pages.pages(), pages.rows(), pages.cols()};
  return open_pages(file, PagedBytes(std::move(pages)), type, std::move(sizes));
}

ArrayContent open_png(const std::filesystem::path& file) {
  const ImageU16 image = read_png_16(file);
  ElementType type;
  type.big_endian = std::endian::native == std::endian::big;
  return open_pages(file, PagedBytes(image), type, {1, image.rows(), image.cols()});
}

ArrayContent open_raw(const std::filesystem::path& file, const ArrayFileOptions& options) {
  if (!options.raw_type) {
    throw InputError(file.string() + ": is a raw binary file; give the 'type' of its numbers: " +
                     element_type_names);
  }
  PlainFile plain(file);
  const std::int64_t data_bytes = plain.size() - options.raw_offset_bytes;
  ArrayContent content{.path = file, .bytes = std::move(plain), .type = *options.raw_type};
  content.shape = ArrayFile::Shape::unknown;
  content.data_offset = options.raw_offset_bytes;
  content.present = std::max<std::int64_t>(0, data_bytes / content.type.bytes);
  content.sizes = {content.present};
  return content;
}

ArrayContent open_array(const std::filesystem::path& file, const ArrayFileOptions& options) {
  refuse_no_file(file);
  const std::string extension = lower_extension(file);
  const bool is_archive = extension == ".npz";
  const bool is_tiff = extension == ".tif" || extension == ".tiff";
  const bool is_raw = !is_archive && !is_tiff && extension != ".npy" && extension != ".png";
  if (!is_raw && (options.raw_type || options.raw_offset_bytes != 0)) {
    throw InputError(file.string() +
                     ": says itself of what type its numbers are; leave out 'type', 'byte_order' "
                     "and 'byte_offset', which are for raw binary files");
  }
  if (!is_archive && !options.member.empty()) {
    throw InputError(file.string() + ": has no 'member'; only .npz files have");
  }
  if (is_archive) return open_numpy(file, ZipMember(file, options.member));
  if (extension == ".npy") return open_numpy(file, PlainFile(file));
  if (is_tiff) return open_tiff(file);
  if (extension == ".png") return open_png(file);
  return open_raw(file, options);
}

}  // namespace

ArrayFile::ArrayFile(const std::filesystem::path& file, const ArrayFileOptions& options)
    : content_(std::make_unique<ArrayContent>(open_array(file, options))) {}

ArrayFile::ArrayFile(ArrayFile&&) noexcept = default;
ArrayFile& ArrayFile::operator=(ArrayFile&&) noexcept = default;
ArrayFile::~ArrayFile() = default;

const std::filesystem::path& ArrayFile::path() const { return content_->path; }
const ElementType& ArrayFile::type() const { return content_->type; }
ArrayFile::Shape ArrayFile::shape() const { return content_->shape; }
const std::vector<std::int64_t>& ArrayFile::sizes() const { return content_->sizes; }
bool ArrayFile::fortran_order() const { return content_->fortran_order; }
std::int64_t ArrayFile::elements_present() const { return content_->present; }

std::vector<std::byte> ArrayFile::read(std::int64_t first, std::int64_t count) {
  if (first + count > content_->present) {
    throw InputError(content_->path.string() + ": is too short: it holds " +
                     std::to_string(content_->present) + " elements, but number " +
                     std::to_string(first + count) + " is wanted");
  }
  const std::int64_t element_bytes = content_->type.bytes;
  std::vector<std::byte> bytes(static_cast<std::size_t>(count * element_bytes));
  naming(content_->path.string(),
         [&] { content_->read(content_->data_offset + first * element_bytes, bytes); });
  return bytes;
}

}  // namespace tofmap
