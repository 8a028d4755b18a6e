// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "range_images.hpp"

#include <gtest/gtest.h>

#include <tofmap/core/error.hpp>
#include <tofmap/core/option_table.hpp>
#include <tofmap/filters/filter_chain.hpp>

namespace tofmap {
namespace {

using test::camera;
using test::plane;

FilterResult filtered(const RangeImage& image, const FilterOptions& options) {
  return apply_filters(image, test::frame_of(image.range_m), test::modulation(),
                       pixel_rays(camera()), options);
}

TEST(FilterChain, RunsInTheOrderThatIsAskedFor) {
  RangeImage image = plane(3);
  image.range_m(7, 9) += 6;  // its neighbours are edges, unless it is gone before
  image.confidence(7, 9) = 0.1F;
  FilterOptions options;
  options.min_confidence = 0.5;
  options.chain = {Filter::jump_edge, Filter::confidence};
  EXPECT_EQ(filtered(image, options).counts[0].removed, 8);
  options.chain = {Filter::confidence, Filter::jump_edge};
  EXPECT_EQ(filtered(image, options).counts[1].removed, 0);
  options.chain.clear();
  EXPECT_EQ(filtered(image, options).image.count_valid(), 20 * 16);
}

TEST(FilterChain, CountsWhatEachFilterRemoves) {
  RangeImage image = plane(3);
  image.confidence(0, 0) = 0.1F;
  FilterOptions options;
  options.min_confidence = 0.5;
  const FilterResult result = filtered(image, options);
  ASSERT_EQ(result.counts.size(), 5U);
  EXPECT_EQ(result.counts[1].filter, Filter::confidence);
  EXPECT_EQ(result.counts[1].removed, 1);
  EXPECT_EQ(result.counts[2].removed, 0);
  EXPECT_EQ(result.counts[3].removed, 0);
  EXPECT_EQ(result.counts[4].removed, 0);
}

TEST(FilterChain, CountsWhatAFilterCorrects) {
  RangeImage image = plane(7);
  image.wrap_count.setConstant(1);
  const Frame frame = test::frame_of(image.range_m);
  image.wrap_count(7, 9) = 0;
  image.range_m(7, 9) -= static_cast<float>(test::modulation().wavelength_m(0));
  const FilterResult result =
      apply_filters(image, frame, test::modulation(), pixel_rays(camera()), {});
  EXPECT_EQ(result.counts[3].filter, Filter::isolated_wrap);
  EXPECT_EQ(result.counts[3].corrected, 1);
  EXPECT_EQ(result.counts[3].removed, 0);
  EXPECT_EQ(result.counts[4].corrected, 0);
}

TEST(FilterChain, RefusesAFilterItDoesNotHave) {
  FilterOptions options;
  OptionTable table;
  table.bind("filters", options);
  EXPECT_THROW(table.set("filters.chain", "jump_edge magic"), UsageError);
  EXPECT_EQ(options.chain, FilterOptions{}.chain);
}

TEST(FilterChain, IsSetByNamesThatBlanksSeparate) {
  FilterOptions options;
  OptionTable table;
  table.bind("filters", options);
  table.set("filters.chain", "  smooth\tjump_edge smooth ");
  EXPECT_EQ(options.chain,
            (std::vector<Filter>{Filter::smooth, Filter::jump_edge, Filter::smooth}));
  table.set("filters.chain", "");
  EXPECT_TRUE(options.chain.empty());
}

TEST(FilterChain, RunsEveryFilterOnAnImageWithoutARange) {
  const RangeImage nothing(16, 20);
  FilterOptions options;
  options.chain.clear();
  for (const NamedValue<Filter>& named : named_values(Filter{})) {
    options.chain.push_back(named.value);
  }
  const FilterResult result = filtered(nothing, options);
  EXPECT_EQ(result.image.count_valid(), 0);
  EXPECT_EQ(count_reason(result.image, InvalidReason::no_return), 20 * 16);
}

}  // namespace
}  // namespace tofmap
