// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include <filesystem>
#include <fstream>
#include <string>

#include <gtest/gtest.h>
#include <support/temporary_folder.hpp>

#include <tofmap/acquisition/png_image.hpp>
#include <tofmap/core/error.hpp>

namespace tofmap {
namespace {

/// The message of the InputError that `call` throws; a failure of the test if it throws none.
template <class Call>
std::string input_error(const Call& call) {
  try {
    call();
  } catch (const InputError& error) {
    return error.what();
  }
  ADD_FAILURE() << "no InputError";
  return "";
}

ImageU16 all_values_of_16_bits() {
  ImageU16 image(256, 256);
  for (int i = 0; i < 65536; ++i) image.data()[i] = static_cast<std::uint16_t>(i);
  return image;
}

TEST(PngImage, KeepsEveryValueOf16Bits) {
  const test::TemporaryFolder folder;
  const ImageU16 image = all_values_of_16_bits();
  write_png(folder.path() / "a.png", image);
  EXPECT_TRUE((read_png_16(folder.path() / "a.png") == image).all());
}

TEST(PngImage, KeepsEveryValueOf8BitsAndTheShape) {
  const test::TemporaryFolder folder;
  ImageU8 image(2, 128);
  for (int i = 0; i < 256; ++i) image.data()[i] = static_cast<std::uint8_t>(i);
  write_png(folder.path() / "a.png", image);
  const ImageU8 read = read_png_8(folder.path() / "a.png");
  ASSERT_TRUE(same_size(read, image));
  EXPECT_TRUE((read == image).all());
}

TEST(PngImage, OfAnotherDepthIsRefusedByName) {
  const test::TemporaryFolder folder;
  write_png(folder.path() / "eight.png", ImageU8(ImageU8::Zero(3, 4)));
  write_png(folder.path() / "sixteen.png", ImageU16(ImageU16::Zero(3, 4)));
  const std::string eight = input_error([&] { read_png_16(folder.path() / "eight.png"); });
  EXPECT_NE(eight.find("eight.png"), std::string::npos) << eight;
  EXPECT_NE(eight.find("16 bits"), std::string::npos) << eight;
  EXPECT_THROW(read_png_8(folder.path() / "sixteen.png"), InputError);
}

TEST(PngImage, CutAnywhereIsAnInputErrorThatNamesTheFile) {
  const test::TemporaryFolder folder;
  const auto whole = folder.path() / "whole.png";
  write_png(whole, all_values_of_16_bits());
  const auto size = std::filesystem::file_size(whole);
  // From nothing at all, through signature, header and pixels, to the missing end mark.
  for (const std::uintmax_t kept : {std::uintmax_t{0}, std::uintmax_t{4}, std::uintmax_t{20},
                                    std::uintmax_t{40}, size / 2, size - 20, size - 1}) {
    const auto cut = folder.path() / "cut.png";
    std::filesystem::copy_file(whole, cut, std::filesystem::copy_options::overwrite_existing);
    std::filesystem::resize_file(cut, kept);
    const std::string message = input_error([&] { read_png_16(cut); });
    EXPECT_NE(message.find("cut.png"), std::string::npos) << kept << " bytes: " << message;
  }
}

TEST(PngImage, WithAFlippedByteIsAnInputError) {
  const test::TemporaryFolder folder;
  const auto file = folder.path() / "a.png";
  write_png(file, all_values_of_16_bits());
  std::fstream bytes(file, std::ios::in | std::ios::out | std::ios::binary);
  bytes.seekp(static_cast<std::streamoff>(std::filesystem::file_size(file) / 2));
  const char old = static_cast<char>(bytes.peek());
  bytes.put(static_cast<char>(~old));
  bytes.close();
  EXPECT_THROW(read_png_16(file), InputError);
}

TEST(PngImage, WithAnAbsurdSizeInItsHeaderIsRefusedBeforeMemoryIsAskedFor) {
  const test::TemporaryFolder folder;
  const auto file = folder.path() / "huge.png";
  // Signature and an IHDR of 100 000 x 100 000 pixels, 16 bits gray, with its right checksum.
  const unsigned char header[] = {0x89, 'P',  'N', 'G', '\r', '\n', 0x1a, '\n', 0,    0,    0,
                                  13,   'I',  'H', 'D', 'R',  0x00, 0x01, 0x86, 0xa0, 0x00, 0x01,
                                  0x86, 0xa0, 16,  0,   0,    0,    0,    0xdd, 0xa9, 0x88, 0x57};
  std::ofstream(file, std::ios::binary).write(reinterpret_cast<const char*>(header), sizeof header);
  EXPECT_THROW(read_png_16(file), InputError);
}

TEST(PngImage, ThatIsMissingOrAFolderIsAnInputError) {
  const test::TemporaryFolder folder;
  EXPECT_THROW(read_png_16(folder.path() / "none.png"), InputError);
  EXPECT_THROW(read_png_16(folder.path()), InputError);
}

TEST(PngImage, ThatDoesNotFitOnTheDiskIsAnInputErrorThatNamesTheFile) {
  if (!std::filesystem::exists("/dev/full")) GTEST_SKIP() << "no /dev/full here";
  // One image below stdio's buffer, whose failure shows at closing, and one above it.
  for (const int side : {2, 256}) {
    const ImageU16 image = all_values_of_16_bits().topLeftCorner(side, side);
    const std::string message = input_error([&] { write_png("/dev/full", image); });
    EXPECT_NE(message.find("/dev/full"), std::string::npos) << message;
  }
}

TEST(PngImage, WithoutPixelsIsWrongUse) {
  const test::TemporaryFolder folder;
  EXPECT_THROW(write_png(folder.path() / "a.png", ImageU16()), UsageError);
}

}  // namespace
}  // namespace tofmap
