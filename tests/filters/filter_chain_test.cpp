// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "range_images.hpp"

#include <gtest/gtest.h>

#include <tofmap/core/error.hpp>
#include <tofmap/filters/filter_chain.hpp>

namespace tofmap {
namespace {

using test::camera;
using test::plane;

TEST(FilterChain, RunsInTheOrderThatIsAskedFor) {
  RangeImage image = plane(3);
  image.range_m(7, 9) += 6;  // its neighbours are edges, unless it is gone before
  image.confidence(7, 9) = 0.1F;
  FilterOptions options;
  options.min_confidence = 0.5;
  options.chain = "jump_edge confidence";
  EXPECT_EQ(apply_filters(image, {}, pixel_rays(camera()), options).counts[0].removed, 8);
  options.chain = "confidence jump_edge";
  EXPECT_EQ(apply_filters(image, {}, pixel_rays(camera()), options).counts[1].removed, 0);
  options.chain = "";
  EXPECT_EQ(apply_filters(image, {}, pixel_rays(camera()), options).image.count_valid(), 20 * 16);
}

TEST(FilterChain, CountsWhatEachFilterRemoves) {
  RangeImage image = plane(3);
  image.confidence(0, 0) = 0.1F;
  FilterOptions options;
  options.min_confidence = 0.5;
  const FilterResult result = apply_filters(image, {}, pixel_rays(camera()), options);
  ASSERT_EQ(result.counts.size(), 3U);
  EXPECT_EQ(result.counts[1].name, "confidence");
  EXPECT_EQ(result.counts[1].removed, 1);
  EXPECT_EQ(result.counts[2].removed, 0);
}

TEST(FilterChain, RefusesAFilterItDoesNotHave) {
  FilterOptions options;
  options.chain = "jump_edge magic";
  EXPECT_THROW(apply_filters(plane(3), {}, pixel_rays(camera()), options), UsageError);
}

}  // namespace
}  // namespace tofmap
