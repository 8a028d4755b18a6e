// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <support/correlation_arrays.hpp>
#include <support/temporary_folder.hpp>

#include <tofmap/acquisition/correlation/array_file.hpp>
#include <tofmap/acquisition/correlation/array_layout.hpp>
#include <tofmap/acquisition/png_image.hpp>

namespace tofmap {
namespace {

using test::bytes_of;
using test::npy;
using test::write_bytes;
using testing::HasSubstr;

class CorrelationArrayFile : public testing::Test {
 protected:
  std::filesystem::path path(const std::string& name) const { return folder_.path() / name; }

  /// All numbers of a file, whatever their type.
  static std::vector<double> numbers(ArrayFile& file, std::int64_t first, std::int64_t count) {
    const std::vector<std::byte> bytes = file.read(first, count);
    std::vector<double> result;
    with_number_type(file.type(), [&](auto number) {
      for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i) {
        result.push_back(static_cast<double>(
            stored_number<decltype(number)>(&bytes[i * sizeof number], file.type().big_endian)));
      }
    });
    return result;
  }

  template <class Number>
  void expect_type(const std::string& name, const std::vector<Number>& values) {
    for (const bool big_endian : {false, true}) {
      for (const int version : {1, 2, 3}) {
        const std::string type = (big_endian ? ">" : "<") + name;
        write_bytes(path("a.npy"), npy(type, "(" + std::to_string(values.size()) + ",)",
                                       bytes_of(values, big_endian), false, version));
        ArrayFile file(path("a.npy"), {});
        const std::vector<double> expected(values.begin(), values.end());
        EXPECT_EQ(numbers(file, 0, static_cast<std::int64_t>(values.size())), expected)
            << type << " version " << version;
      }
    }
  }

  /// The complaint about a .npy file of these bytes.
  std::string complaint(const std::string& bytes) const {
    write_bytes(path("bad.npy"), bytes);
    return test::input_error([&] { ArrayFile(path("bad.npy"), {}); });
  }

  test::TemporaryFolder folder_;
};

TEST_F(CorrelationArrayFile, OfNumpyIsReadInAllTypesByteOrdersAndVersions) {
  expect_type<std::uint8_t>("u1", {0, 1, 255});
  expect_type<std::int8_t>("i1", {-128, 0, 127});
  expect_type<std::uint16_t>("u2", {0, 258, 65535});
  expect_type<std::int16_t>("i2", {-32768, 0, 258});
  expect_type<std::uint32_t>("u4", {0, 16909060, 4294967295});
  expect_type<std::int32_t>("i4", {-2147483647, 16909060});
  expect_type<std::int64_t>("i8", {-3, 1099511627776});
  expect_type<float>("f4", {-1.5F, 0.25F});
  expect_type<double>("f8", {-1.5, 1e100});
}

TEST_F(CorrelationArrayFile, IsReadInPartsWithoutTheRest) {
  // A sparse file of 20 GB: only its header and its last numbers are on the disk.
  write_bytes(path("big.npy"), npy("<u2", "(100000, 100000)", ""));
  const auto header = std::filesystem::file_size(path("big.npy"));
  std::filesystem::resize_file(path("big.npy"), header + 20'000'000'000);
  std::fstream out(path("big.npy"), std::ios::in | std::ios::out | std::ios::binary);
  out.seekp(-4, std::ios::end);
  out.write(bytes_of<std::uint16_t>({7, 9}).data(), 4);
  out.close();
  ArrayFile file(path("big.npy"), {});
  EXPECT_EQ(file.elements_present(), 10'000'000'000);
  EXPECT_EQ(numbers(file, 9'999'999'997, 3), (std::vector<double>{0, 7, 9}));
}

TEST_F(CorrelationArrayFile, InFortranOrderHasItsFirstIndexFastest) {
  // a[frame, column] = 10 frame + column, of 2 frames and 3 columns.
  const auto data = bytes_of<std::uint16_t>({0, 10, 1, 11, 2, 12});
  write_bytes(path("a.npy"), npy("<u2", "(2, 3)", data, true));
  ArrayFile file(path("a.npy"), {});
  const ArrayLayout layout =
      array_layout(file, {ArrayAxis::frame, ArrayAxis::column}, {.columns = 3});
  EXPECT_EQ(layout.frames, 2);
  const std::vector<std::byte> frame = read_frame(file, layout, 1);
  std::vector<int> values;
  for (std::size_t i = 0; i < 3; ++i) {
    values.push_back(stored_number<std::uint16_t>(&frame[2 * i], false));
  }
  EXPECT_EQ(values, (std::vector<int>{10, 11, 12}));
}

TEST_F(CorrelationArrayFile, WithABadHeaderIsNamedWithTheReason) {
  const std::string data = bytes_of<std::uint16_t>({1, 2, 3, 4, 5, 6});
  EXPECT_EQ(complaint(npy("<u2", "(2, 3)", data)), "");
  EXPECT_THAT(complaint("PK" + data), HasSubstr("bad.npy: is not a .npy file"));
  EXPECT_THAT(complaint(""), HasSubstr("is not a .npy file"));
  EXPECT_THAT(complaint(npy("<u2", "(2, 3)", data).substr(0, 40)), HasSubstr("the file ends"));
  EXPECT_THAT(complaint(npy("<u2", "(2, 3)", data, false, 4)), HasSubstr("version 4"));
  EXPECT_THAT(complaint(npy("|O", "(2, 3)", data)), HasSubstr("type '|O'"));
  EXPECT_THAT(complaint(npy("<c8", "(2, 3)", data)), HasSubstr("type '<c8'"));
  EXPECT_THAT(complaint(npy("<f2", "(2, 3)", data)), HasSubstr("type '<f2'"));
  EXPECT_THAT(complaint(npy("<u2", "(2, -3)", data)), HasSubstr("shape"));
  EXPECT_THAT(complaint(npy("<u2", "(0, 3)", data)), HasSubstr("shape"));
  EXPECT_THAT(complaint(npy("<u2", "(2; 3)", data)), HasSubstr("shape"));
  EXPECT_THAT(complaint(npy("<u2", "2, 3", data)), HasSubstr("shape"));
  EXPECT_THAT(complaint(npy("<u2", "(4611686018427387904, 4611686018427387904)", data)),
              HasSubstr("more elements than any file"));
  EXPECT_THAT(complaint(npy("<u2", "(2, 2)", data)), HasSubstr("12 bytes of data"));
  EXPECT_THAT(complaint(test::npy_with_header("{'descr': [('a', '<u2')]}", data)),
              HasSubstr("structures"));
  EXPECT_THAT(complaint(test::npy_with_header("{'shape': (6,), 'fortran_order': False}", data)),
              HasSubstr("no key 'descr'"));
  EXPECT_THAT(
      complaint(test::npy_with_header("{'descr': '<u2', 'shape': (6,), 'fortran_order': 1}", data)),
      HasSubstr("fortran_order"));
  EXPECT_THAT(test::input_error([&] { ArrayFile(path("none.npy"), {}); }), HasSubstr("none.npy"));
  EXPECT_THAT(test::input_error([&] { ArrayFile(folder_.path(), {}); }), HasSubstr("is a folder"));
}

TEST_F(CorrelationArrayFile, ThatIsTruncatedHoldsWhatIsLeft) {
  const std::string bytes = npy("<u2", "(2, 3)", bytes_of<std::uint16_t>({1, 2, 3, 4, 5, 6}));
  write_bytes(path("cut.npy"), bytes.substr(0, bytes.size() - 3));
  ArrayFile file(path("cut.npy"), {});
  EXPECT_EQ(file.elements_present(), 4);
  EXPECT_EQ(numbers(file, 0, 4), (std::vector<double>{1, 2, 3, 4}));
  EXPECT_THAT(test::input_error([&] { file.read(2, 3); }), HasSubstr("cut.npy: is too short"));
  const ArrayLayout layout =
      array_layout(file, {ArrayAxis::frame, ArrayAxis::column}, {.columns = 3});
  EXPECT_TRUE(holds_frame(file, layout, 0));
  EXPECT_FALSE(holds_frame(file, layout, 1));
}

TEST_F(CorrelationArrayFile, OfAnArchiveIsReadForwardsAndBackwards) {
  std::vector<std::uint16_t> values(100000);
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = static_cast<std::uint16_t>(i * i);
  const std::string array = npy("<u2", "(100000,)", bytes_of(values));
  for (const bool deflate : {false, true}) {
    test::write_npz(path("a.npz"), {{"x.npy", npy("<u2", "(1,)", "ab")}, {"y.npy", array}},
                    deflate);
    ArrayFile file(path("a.npz"), {.member = "y"});
    for (const std::int64_t first : {0, 10, 90000, 500, 99999}) {
      EXPECT_EQ(numbers(file, first, 1)[0], values[static_cast<std::size_t>(first)]) << deflate;
    }
    EXPECT_EQ(numbers(file, 0, 100000).back(), values.back());
  }
}

TEST_F(CorrelationArrayFile, OfADamagedArchiveIsNamed) {
  const std::string array = npy("<u2", "(1000,)", bytes_of(std::vector<std::uint16_t>(1000, 7)));
  test::write_npz(path("a.npz"), {{"x.npy", array}, {"y.npy", array}}, false);
  EXPECT_THAT(test::input_error([&] { ArrayFile(path("a.npz"), {}); }), HasSubstr("x and y"));
  EXPECT_THAT(test::input_error([&] { ArrayFile(path("a.npz"), {.member = "z"}); }),
              HasSubstr("no member 'z'"));
  std::filesystem::resize_file(path("a.npz"), 1500);
  EXPECT_THAT(test::input_error([&] { ArrayFile(path("a.npz"), {.member = "x"}); }),
              HasSubstr("not a complete .npz file"));
  test::write_npz(path("b.npz"), {{"readme.txt", "text"}}, false);
  EXPECT_THAT(test::input_error([&] { ArrayFile(path("b.npz"), {}); }), HasSubstr("no array"));
}

TEST_F(CorrelationArrayFile, OfAnArchiveWithAFlippedByteIsDamaged) {
  std::vector<std::uint16_t> values(1000);
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = static_cast<std::uint16_t>(i * 77);
  for (const bool deflate : {false, true}) {
    test::write_npz(path("a.npz"), {{"x.npy", npy("<u2", "(1000,)", bytes_of(values))}}, deflate);
    std::fstream bytes(path("a.npz"), std::ios::in | std::ios::out | std::ios::binary);
    bytes.seekp(700);
    const char old = static_cast<char>(bytes.peek());
    bytes.put(static_cast<char>(~old));
    bytes.close();
    EXPECT_THAT(test::input_error([&] { ArrayFile(path("a.npz"), {}).read(0, 1000); }),
                HasSubstr("damaged"))
        << deflate;
  }
}

TEST_F(CorrelationArrayFile, OfRawNumbersStartsAtItsOffset) {
  write_bytes(path("a.bin"), "head" + bytes_of<std::int16_t>({-2, 300, 5}, true) + "x");
  const ElementType type{ElementType::Kind::signed_integer, 2, true};
  ArrayFile file(path("a.bin"), {.raw_type = type, .raw_offset_bytes = 4});
  EXPECT_EQ(file.elements_present(), 3);
  EXPECT_EQ(numbers(file, 0, 3), (std::vector<double>{-2, 300, 5}));
  EXPECT_THAT(test::input_error([&] { ArrayFile(path("a.bin"), {}); }), HasSubstr("'type'"));
  EXPECT_THAT(test::input_error([&] { ArrayFile(path("a.npy"), {.raw_type = type}); }),
              HasSubstr("leave out 'type'"));
  EXPECT_THAT(
      test::input_error([&] { ArrayFile(path("a.bin"), {.member = "x", .raw_type = type}); }),
      HasSubstr("'member'"));
}

ImageU16 ramp(int rows, int cols, int first) {
  ImageU16 image(rows, cols);
  for (int i = 0; i < rows * cols; ++i) image.data()[i] = static_cast<std::uint16_t>(first + i);
  return image;
}

TEST_F(CorrelationArrayFile, OfPagesIsReadInAnyOrder) {
  for (const int compression : {COMPRESSION_NONE, COMPRESSION_LZW, COMPRESSION_ADOBE_DEFLATE}) {
    test::write_tiff(path("a.tif"), {ramp(3, 4, 0), ramp(3, 4, 100), ramp(3, 4, 300)}, compression);
    ArrayFile file(path("a.tif"), {});
    EXPECT_EQ(file.sizes(), (std::vector<std::int64_t>{3, 3, 4}));
    EXPECT_EQ(numbers(file, 26, 1)[0], 302);
    EXPECT_EQ(numbers(file, 10, 4), (std::vector<double>{10, 11, 100, 101}));
  }
}

TEST_F(CorrelationArrayFile, OfPagesThatAreUnlikeOrCutIsDamaged) {
  test::write_tiff(path("a.tif"), {ramp(3, 4, 0), ramp(4, 4, 0), ramp(3, 4, 9)});
  ArrayFile file(path("a.tif"), {});
  for (int again = 0; again < 2; ++again) {
    EXPECT_THAT(test::input_error([&] { file.read(12, 1); }), HasSubstr("another size"));
  }
  EXPECT_EQ(numbers(file, 24, 1)[0], 9);
  test::write_tiff(path("b.tif"), {ramp(300, 400, 0)});
  for (const int kept : {0, 4, 100, 5000}) {
    std::filesystem::copy_file(path("b.tif"), path("c.tif"),
                               std::filesystem::copy_options::overwrite_existing);
    std::filesystem::resize_file(path("c.tif"), static_cast<std::uintmax_t>(kept));
    EXPECT_THAT(test::input_error([&] { ArrayFile(path("c.tif"), {}).read(0, 120000); }),
                HasSubstr("c.tif"))
        << kept;
  }
}

TEST_F(CorrelationArrayFile, OfAPngHas16Bits) {
  write_png(path("a.png"), ramp(3, 4, 65500));
  ArrayFile file(path("a.png"), {});
  EXPECT_EQ(numbers(file, 2, 2), (std::vector<double>{65502, 65503}));
  write_png(path("b.png"), ImageU8(ImageU8::Zero(3, 4)));
  EXPECT_THAT(test::input_error([&] { ArrayFile(path("b.png"), {}); }), HasSubstr("16 bits"));
}

TEST_F(CorrelationArrayFile, OfAnotherShapeThanExpectedIsNamedWithBoth) {
  write_bytes(path("a.npy"), npy("<u2", "(4, 2, 3)", std::string(48, '\0')));
  const ArrayFile file(path("a.npy"), {});
  const std::vector<ArrayAxis> axes = {ArrayAxis::frame, ArrayAxis::step, ArrayAxis::column};
  EXPECT_EQ(array_layout(file, axes, {.steps = 2, .columns = 3}).frames, 4);
  const std::string message =
      test::input_error([&] { array_layout(file, axes, {.steps = 4, .columns = 3}); });
  EXPECT_THAT(message, HasSubstr("a.npy: has the shape 4 x 2 x 3"));
  EXPECT_THAT(message, HasSubstr("frame (any) x step (4) x column (3)"));
  EXPECT_EQ(array_layout(file, axes, {.steps = 4, .columns = 3}, true).frames, 2) << "reshaped";
}

}  // namespace
}  // namespace tofmap
