// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "support/kinect2_samples.hpp"

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>

#include <gtest/gtest.h>
#include <support/temporary_folder.hpp>

#include <tofmap/acquisition/kinect2/p0_tables.hpp>

namespace tofmap::kinect2 {
namespace {

class Kinect2P0Tables : public testing::Test {
 protected:
  std::filesystem::path file() const { return folder_.path() / "p0.bin"; }

  void append(const std::string& bytes) const {
    std::ofstream(file(), std::ios::binary | std::ios::app) << bytes;
  }

  static void expect_same(const P0Tables& a, const P0Tables& b) {
    for (std::size_t f = 0; f < 3; ++f) {
      ASSERT_TRUE(same_size(a.tables[f], b.tables[f]));
      EXPECT_TRUE((a.tables[f] == b.tables[f]).all()) << f;
    }
  }

  /// Expects that the file is refused with a message that tells where such a file comes from.
  void expect_refusal(const std::string& part) const {
    const std::string message = test::input_error([&] { read_p0_tables(file()); });
    test::expect_part(message, "p0.bin");
    test::expect_part(message, part);
    test::expect_part(message, "calibration/p0.bin; each camera has its own");
  }

  test::TemporaryFolder folder_;
};

TEST_F(Kinect2P0Tables, ReadBackAsWritten) {
  write_p0_tables(file(), test::sample_p0_tables());
  expect_same(read_p0_tables(file()), test::sample_p0_tables());
}

TEST_F(Kinect2P0Tables, OfOneNumberOrOfUnrelatedOnesAreRefused) {
  P0Tables p0 = test::sample_p0_tables();
  p0.tables[1].setZero();
  write_p0_tables(file(), p0);
  expect_refusal("table 1 is 0 everywhere");
  std::uint32_t number = 1;
  for (std::uint16_t& value : p0.tables[1].reshaped()) {
    number = number * 1664525U + 1013904223U;  // a linear congruential generator
    value = static_cast<std::uint16_t>(number >> 16U);
  }
  std::filesystem::remove(file());
  write_p0_tables(file(), p0);
  expect_refusal("table 1 holds unrelated numbers");
}

TEST_F(Kinect2P0Tables, HaveTheLayoutOfTheCamerasAnswer) {
  const P0Tables p0 = test::sample_p0_tables();
  write_p0_tables(file(), p0);
  EXPECT_EQ(std::filesystem::file_size(file()), 1'302'572U);
  std::ifstream in(file(), std::ios::binary);
  const auto word_at = [&](std::streamoff at) {
    in.seekg(at);
    const int low = in.get();
    return low + 256 * in.get();
  };
  EXPECT_EQ(word_at(34), p0.tables[0](0, 0));
  EXPECT_EQ(word_at(36), p0.tables[0](0, 1));
  EXPECT_EQ(word_at(34 + 434176 + 4), p0.tables[1](0, 0));
  EXPECT_EQ(word_at(34 + 2 * (434176 + 4) + 2 * 512), p0.tables[2](1, 0));
  EXPECT_EQ(word_at(1'302'572 - 4), p0.tables[2](423, 511));
}

TEST_F(Kinect2P0Tables, MayBeFollowedByOtherBytes) {
  write_p0_tables(file(), test::sample_p0_tables());
  append(std::string(36, 'x'));
  expect_same(read_p0_tables(file()), test::sample_p0_tables());
}

TEST_F(Kinect2P0Tables, AreReadWithoutHeaders) {
  const P0Tables p0 = test::sample_p0_tables();
  for (const ImageU16& table : p0.tables) {
    std::string bytes;
    for (Eigen::Index i = 0; i < table.size(); ++i) {
      bytes.push_back(static_cast<char>(table.data()[i] & 255));
      bytes.push_back(static_cast<char>(table.data()[i] >> 8));
    }
    append(bytes);
  }
  ASSERT_EQ(std::filesystem::file_size(file()), 1'302'528U);
  expect_same(read_p0_tables(file()), p0);
}

TEST_F(Kinect2P0Tables, ThatAreMissingAreNamedWithTheirOrigin) { expect_refusal("no such file"); }

TEST_F(Kinect2P0Tables, OfAnotherSizeAreNamedWithTheirOrigin) {
  for (const int size : {0, 1, 1'302'527, 1'302'529, 1'302'571, 2'984'960}) {
    std::ofstream(file()) << "";
    std::filesystem::resize_file(file(), static_cast<std::uintmax_t>(size));
    expect_refusal(size == 2'984'960 ? "more than 1835008 bytes" : std::to_string(size) + " bytes");
  }
}

TEST_F(Kinect2P0Tables, ThatAreAFolderAreRefused) {
  std::filesystem::create_directory(file());
  test::expect_part(test::input_error([&] { read_p0_tables(file()); }), "is a folder");
}

TEST_F(Kinect2P0Tables, ThatCannotBeWrittenAreNamed) {
  const auto lost = folder_.path() / "no" / "p0.bin";
  const P0Tables p0 = test::sample_p0_tables();
  test::expect_part(test::input_error([&] { write_p0_tables(lost, p0); }), lost.string());
}

TEST_F(Kinect2P0Tables, OfAnotherShapeAreWrongUse) {
  P0Tables p0 = test::sample_p0_tables();
  p0.tables[1].setZero(512, 424);
  EXPECT_THROW(write_p0_tables(file(), p0), UsageError);
  EXPECT_FALSE(std::filesystem::exists(file()));
}

}  // namespace
}  // namespace tofmap::kinect2
