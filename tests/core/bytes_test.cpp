// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tofmap/core/bytes.hpp"

#include <cstdint>
#include <limits>
#include <string>
#include <string_view>

#include <gtest/gtest.h>

namespace tofmap {
namespace {

std::string sample() {
  ByteWriter out;
  out.number(0.1);
  out.number<std::uint8_t>(7);
  out.image(ImageF(ImageF::Constant(2, 3, nan)));
  out.image(ImageU8());
  return out.take();
}

TEST(Bytes, AreReadToTheBit) {
  const std::string bytes = sample();
  ByteReader in(bytes);
  EXPECT_EQ(in.number<double>(), 0.1);
  EXPECT_EQ(in.number<std::uint8_t>(0, 7), 7);
  const auto image = in.image<float>(2, 3);
  EXPECT_EQ(image.rows(), 2);
  EXPECT_TRUE(image.isNaN().all());
  EXPECT_EQ(in.image<std::uint8_t>(2, 3).size(), 0) << "an empty image stays empty";
  EXPECT_NO_THROW(in.expect_end());
}

TEST(Bytes, AreRefusedIfTheyEndEarlyOrLate) {
  const std::string bytes = sample();
  for (std::size_t size = 0; size < bytes.size(); ++size) {
    ByteReader in(std::string_view(bytes).substr(0, size));
    EXPECT_THROW(
        {
          in.number<double>();
          in.number<std::uint8_t>();
          in.image<float>(2, 3);
          in.image<std::uint8_t>(2, 3);
        },
        InputError)
        << size;
  }
  ByteReader in(bytes);
  in.number<double>();
  EXPECT_THROW(in.expect_end(), InputError);
}

TEST(Bytes, AreRefusedIfANumberCannotBe) {
  ByteWriter out;
  out.number(std::numeric_limits<double>::infinity());
  out.number(8);
  const std::string bytes = out.take();
  ByteReader in(bytes);
  EXPECT_THROW(in.number<double>(), InputError);
  EXPECT_THROW(in.number(0, 7), InputError);
}

}  // namespace
}  // namespace tofmap
