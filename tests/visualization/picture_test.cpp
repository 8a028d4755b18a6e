// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "pixel_count.hpp"

#include <gtest/gtest.h>
#include <support/temporary_folder.hpp>
#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkPNGReader.h>

#include <tofmap/core/error.hpp>
#include <tofmap/visualization/picture.hpp>

namespace tofmap {
namespace {

constexpr Rgb blue{0, 0, 255};

using test::count;
using test::red;

TEST(Picture, ThatIsPastedOverTheBorderIsCutOff) {
  Picture picture(4, 3);
  paste(picture, Picture(2, 2, red), 3, -1);
  EXPECT_EQ(count(picture, red), 1);
  EXPECT_EQ(picture.at(3, 0), red);
  paste(picture, Picture(9, 9, blue), -2, -2);
  EXPECT_EQ(count(picture, blue), 12);
}

TEST(Picture, IsFilledWithinItsBorders) {
  Picture picture(4, 3);
  fill(picture, -1, 1, 3, 9, red);
  EXPECT_EQ(count(picture, red), 4);
}

TEST(Picture, IsMagnifiedBySquares) {
  Picture small(2, 1);
  small.at(1, 0) = red;
  const Picture large = magnified(small, 3);
  EXPECT_EQ(large.width_px, 6);
  EXPECT_EQ(large.height_px, 3);
  EXPECT_EQ(large.at(2, 2), colors::white);
  EXPECT_EQ(large.at(3, 0), red);
  EXPECT_EQ(count(large, red), 9);
}

TEST(Pictures, StandBesideAndAboveOneAnother) {
  const Picture row = beside({Picture(2, 5, red), Picture(3, 4, blue)}, 1);
  EXPECT_EQ(row.width_px, 6);
  EXPECT_EQ(row.height_px, 5);
  EXPECT_EQ(row.at(2, 0), colors::white);
  EXPECT_EQ(row.at(3, 0), blue);
  const Picture column = stacked({Picture(2, 5, red), Picture(3, 4, blue)}, 1);
  EXPECT_EQ(column.width_px, 3);
  EXPECT_EQ(column.height_px, 10);
  EXPECT_EQ(column.at(0, 6), blue);
  EXPECT_EQ(beside({}, 4).width_px, 0);
}

TEST(Text, IsAsHighAsAskedForAndHasInk) {
  const Picture text = text_picture("12.5 m", 18);
  EXPECT_GT(text.height_px, 9);
  EXPECT_LT(text.height_px, 36);
  EXPECT_GT(text.width_px, text.height_px);
  EXPECT_GT(count(text, colors::black), 20);
  EXPECT_GT(count(text, colors::white), 100);
}

TEST(ColorBar, RunsFromLowBelowToHighAbove) {
  const ColorScale scale(0, 10, "range, m");
  const Picture bar = color_bar(scale, 300);
  EXPECT_EQ(bar.height_px, 300);
  int first_high = -1;
  int first_low = -1;
  for (int y = 0; y < bar.height_px; ++y) {
    if (first_high < 0 && bar.at(1, y) == scale(10)) first_high = y;
    if (first_low < 0 && bar.at(1, y) == scale(0)) first_low = y;
  }
  ASSERT_GT(first_high, 0);
  EXPECT_GT(first_low, first_high + 200);
}

TEST(Picture, IsWrittenAsPngAndReadBackTheSame) {
  Picture picture(5, 3);
  for (int y = 0; y < 3; ++y) {
    for (int x = 0; x < 5; ++x) {
      picture.at(x, y) = {static_cast<std::uint8_t>(40 * x), static_cast<std::uint8_t>(100 * y), 7};
    }
  }
  const test::TemporaryFolder folder;
  const auto file = folder.path() / "a.png";
  write_picture(file, picture);

  vtkNew<vtkPNGReader> reader;
  reader->SetFileName(file.c_str());
  reader->Update();
  vtkImageData* image = reader->GetOutput();
  ASSERT_EQ(image->GetDimensions()[0], 5);
  ASSERT_EQ(image->GetDimensions()[1], 3);
  for (int y = 0; y < 3; ++y) {
    for (int x = 0; x < 5; ++x) {
      const auto* rgb = static_cast<const unsigned char*>(image->GetScalarPointer(x, 2 - y, 0));
      EXPECT_EQ((Rgb{rgb[0], rgb[1], rgb[2]}), picture.at(x, y)) << x << ", " << y;
    }
  }
}

TEST(Picture, ThatCannotBeWrittenIsAnErrorThatNamesTheFile) {
  try {
    write_picture("/no/such/folder/a.png", Picture(2, 2));
    FAIL() << "no error";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("/no/such/folder/a.png"), std::string::npos);
  }
}

}  // namespace
}  // namespace tofmap
