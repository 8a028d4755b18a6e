// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

// Measures which pixels filters remove, and prints Markdown tables; writes plots if a folder is
// given:
//
//     bench_filter_accuracy [--divide N] [--plots DIR] [--only flying] [--mesh FILE]
// The recordings are simulated, so that it is known which pixels are flying. N divides the number
// of frames. `--only flying` prints only the tables of flying pixels per recording. A mesh file
// adds a recording to the frozen ones.

#include "pcl_filters.hpp"
#include "recordings.hpp"
#include "samples.hpp"
#include "score.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <vector>

#include <tofmap/filters/filter_chain.hpp>
#include <tofmap/filters/view_fusion.hpp>
#include <tofmap/visualization/plot.hpp>

namespace tofmap::bench {
namespace {

/// The name of this chain. It is left out of the plots, since it removes the same pixels as
/// plane_edge.
const std::string chain_of_unwrap = "the chain of `unwrap --filters`";

MeasuredFilter chain(const std::string& name, const FilterOptions& options) {
  return {name, [options](const Case& example, const Sample& sample) {
            return apply_filters(sample.unwrapped, sample.simulated.frame,
                                 example.sensor.modulation, example.rays, options)
                .image;
          }};
}

std::vector<MeasuredFilter> all_filters() {
  std::vector<MeasuredFilter> all;
  FilterOptions options;
  options.chain.clear();
  all.push_back(chain("none", options));
  FilterOptions as_published;
  as_published.chain = {Filter::jump_edge};
  as_published.min_edge_gap_sigmas = 0;
  all.push_back(chain("jump_edge, as published", as_published));
  for (const Filter filter : {Filter::jump_edge, Filter::step_edge, Filter::plane_edge,
                              Filter::outlier, Filter::smooth}) {
    options.chain = {filter};
    all.push_back(chain(std::string(name_of(filter)), options));
  }
  options.chain = smoothing_chain();
  all.push_back(chain(chain_of_unwrap, options));
  std::ranges::copy(pcl_filters(), std::back_inserter(all));
  return all;
}

/// A share in percent, or a dash if there are no pixels.
std::string percent(const Share& share, int digits) {
  if (share.all == 0) return "–";
  char text[32];
  std::snprintf(text, sizeof text, "%.*f", digits, share.percent());
  return text;
}

struct NamedScore {
  std::string name;
  Score score;
};

void print_scores(const std::string& title, const std::vector<NamedScore>& scores) {
  std::printf(
      "\n| %s | flying found, %% | removed are mixed, %% | right lost, %% | beyond 5 m | to 60° | "
      "to 70° | to 80° | to 90° | RMSE, cm | relative to unfiltered | median | ms |\n"
      "|---|---|---|---|---|---|---|---|---|---|---|---|---|\n",
      title.c_str());
  for (const auto& [name, score] : scores) {
    std::printf("| %s | %s | %s | %s | %s |", name.c_str(), percent(score.found, 1).c_str(),
                percent(score.precise, 1).c_str(), percent(score.lost(), 2).c_str(),
                percent(score.lost_beyond_far(), 2).c_str());
    constexpr std::array<std::size_t, 5> degrees{0, 60, 70, 80, Score::angles};
    for (std::size_t i = 1; i < degrees.size(); ++i) {
      std::printf(" %s |", percent(score.lost_between(degrees[i - 1], degrees[i]), 2).c_str());
    }
    std::printf(" %.2f | %.2f | %.2f | %.2f |\n", 100 * score.rmse_m(), score.rms_share(),
                score.median_share(), score.milliseconds);
  }
  std::fflush(stdout);
}

/// A line of shares for groups of `width` bins. It has gaps where a group has fewer than 200
/// pixels.
template <std::size_t Size>
PlotLine line_of(const std::string& name, const std::array<Share, Size>& bins, std::size_t width) {
  constexpr double least_pixels = 200;
  PlotLine line{name, {}, {}};
  for (std::size_t first = 0; first + width <= Size; first += width) {
    Share sum;
    for (std::size_t i = first; i < first + width; ++i) sum.add(bins[i]);
    line.x.push_back(static_cast<double>(first) + static_cast<double>(width) / 2);
    line.y.push_back(sum.all < least_pixels ? std::nan("") : sum.percent());
  }
  return line;
}

/// Writes plots of the lost pixels for the filters that remove pixels.
void write_plots(const std::filesystem::path& folder, const std::vector<NamedScore>& scores) {
  constexpr int width_px = 900;
  constexpr int height_px = 540;
  Plot by_angle{.title = "Good pixels lost, by incidence",
                .x_label = "incidence, degrees",
                .y_label = "lost, %",
                .lines = {},
                .x_limit = 90,
                .y_limit = 20};
  Plot by_range{.title = "Good pixels lost, by range",
                .x_label = "range, m",
                .y_label = "lost, %",
                .lines = {},
                .x_limit = 20,
                .y_limit = 20};
  for (const auto& [name, score] : scores) {
    const bool removes = score.precise.all > 0;
    if (!removes || name == chain_of_unwrap) continue;
    by_angle.lines.push_back(line_of(name, score.lost_by_angle, 5));
    by_range.lines.push_back(line_of(name, score.lost_by_range, 1));
  }
  std::filesystem::create_directories(folder);
  write_picture(folder / "lost_by_incidence.png", plot_picture(by_angle, width_px, height_px));
  write_picture(folder / "lost_by_range.png", plot_picture(by_range, width_px, height_px));
}

/// The share of pixels that are off by more than half a wavelength of A.
Share wrong_wraps(const RangeImage& image, const Sample& sample, const Case& example) {
  const auto half_m = static_cast<float>(example.sensor.modulation.wavelength_m(0) / 2);
  Share wrong;
  for (Eigen::Index i = 0; i < image.range_m.size(); ++i) {
    const float error_m = image.range_m.data()[i] - sample.simulated.range_truth_m.data()[i];
    if (std::isfinite(error_m)) wrong.add(std::abs(error_m) > half_m);
  }
  return wrong;
}

void print_isolated_wraps(const std::string& method, int divisor) {
  FilterOptions options;
  options.chain = {Filter::isolated_wrap};
  for (const Case& example : make_cases(method, divisor)) {
    Share before;
    Share after;
    int corrected = 0;
    int dropped = 0;
    for (const Sample& sample : example.samples) {
      const FilterResult result = apply_filters(sample.unwrapped, sample.simulated.frame,
                                                example.sensor.modulation, example.rays, options);
      before.add(wrong_wraps(sample.unwrapped, sample, example));
      after.add(wrong_wraps(result.image, sample, example));
      corrected += result.counts[0].corrected;
      dropped += result.counts[0].removed;
    }
    const auto frames = static_cast<double>(example.samples.size());
    std::printf("| %s | %s | %s | %s | %.1f | %.1f |\n", method.c_str(), example.name.c_str(),
                percent(before, 3).c_str(), percent(after, 3).c_str(), corrected / frames,
                dropped / frames);
    std::fflush(stdout);
  }
}

/// The default chain, followed by fusion with `views` frames before and after.
MeasuredFilter fused(int views) {
  return {
      "± " + std::to_string(views) + " frames", [views](const Case& run, const Sample& sample) {
        std::vector<RangeImage> images;
        std::vector<PosedView> posed;
        const auto own = static_cast<int>(&sample - run.samples.data());
        const int last = std::min(static_cast<int>(run.samples.size()) - 1, own + views);
        const int first = std::max(0, own - views);
        for (int i = first; i <= last; ++i) {
          const Sample& other = run.samples[static_cast<std::size_t>(i)];
          images.push_back(apply_filters(other.unwrapped, other.simulated.frame,
                                         run.sensor.modulation, run.rays, {})
                               .image);
        }
        for (int i = first; i <= last; ++i) {
          posed.push_back({&images[static_cast<std::size_t>(i - first)],
                           run.samples[static_cast<std::size_t>(i)].simulated.world_from_camera});
        }
        const PosedView self = posed[static_cast<std::size_t>(own - first)];
        posed.erase(posed.begin() + (own - first));
        return fuse_views(self, posed, run.sensor.camera, run.rays, {});
      }};
}

void print_fusion(int divisor) {
  for (const char* scene : {"room", "hall", "corridor"}) {
    const Case run = make_run(scene, std::max(5, 16 / divisor));
    std::vector<NamedScore> scores;
    for (const int views : {0, 1, 2, 4}) {
      scores.push_back({fused(views).name, score_filter(fused(views), run)});
    }
    print_scores("fusion, " + run.name, scores);
  }
}

/// Prints which pixels the default chain finds and loses in each recording.
void print_flying(const std::string& title, const std::vector<Recording>& recordings, int divisor) {
  std::printf(
      "\n| %s | frames | labelled flying, a frame | of these found, %% | flying in range, too: "
      "found, %% | right lost, %% | within 1 m |\n|---|---|---|---|---|---|---|\n",
      title.c_str());
  for (const Recording& recording : recordings) {
    const Case example = make_case(recording, divisor);
    const Score score = score_filter(chain("", {}), example);
    const std::size_t frames = example.samples.size();
    std::printf("| %s | %zu | %.0f | %s | %s | %s | %s |\n", recording.name.c_str(), frames,
                score.found_by_label.all / static_cast<double>(frames),
                percent(score.found_by_label, 1).c_str(), percent(score.found, 1).c_str(),
                percent(score.lost(), 2).c_str(), percent(score.lost_within_a_metre(), 2).c_str());
    std::fflush(stdout);
  }
}

struct Arguments {
  int divisor = 1;
  std::filesystem::path plots;
  bool only_flying = false;
  std::string mesh;
};

void print_all_flying(const Arguments& arguments) {
  std::vector<Recording> frozen = frozen_recordings();
  if (!arguments.mesh.empty()) {
    frozen.push_back(
        {.name = std::filesystem::path(arguments.mesh).stem().string(), .scene = arguments.mesh});
  }
  print_flying("development", development_recordings(), arguments.divisor);
  print_flying("frozen", frozen, arguments.divisor);
}

Arguments read_arguments(const std::vector<std::string>& words) {
  Arguments arguments;
  for (std::size_t i = 0; i + 1 < words.size(); i += 2) {
    if (words[i] == "--divide") {
      arguments.divisor = std::max(1, std::stoi(words[i + 1]));
    } else if (words[i] == "--plots") {
      arguments.plots = words[i + 1];
    } else if (words[i] == "--only" && words[i + 1] == "flying") {
      arguments.only_flying = true;
    } else if (words[i] == "--mesh") {
      arguments.mesh = words[i + 1];
    } else {
      throw std::invalid_argument(words[i] +
                                  ": --divide, --plots, --only flying, --mesh are known");
    }
  }
  return arguments;
}

void run(const Arguments& arguments) {
  print_all_flying(arguments);
  if (arguments.only_flying) return;
  const std::vector<MeasuredFilter> filters = all_filters();
  std::vector<std::vector<Score>> by_filter(filters.size());
  for (const Case& example : make_cases("joint", arguments.divisor)) {
    std::vector<NamedScore> scores;
    for (std::size_t i = 0; i < filters.size(); ++i) {
      scores.push_back({filters[i].name, score_filter(filters[i], example)});
      by_filter[i].push_back(scores.back().score);
    }
    print_scores(example.name, scores);
  }
  std::vector<NamedScore> together;
  for (std::size_t i = 0; i < filters.size(); ++i) {
    together.push_back({filters[i].name, joined(by_filter[i])});
  }
  print_scores("all", together);
  if (!arguments.plots.empty()) write_plots(arguments.plots, together);

  print_fusion(arguments.divisor);
  std::printf(
      "\n| method | scene | wrong wraps, %% | after isolated_wrap | corrected a frame | dropped a "
      "frame |\n|---|---|---|---|---|---|\n");
  for (const char* method : {"pixel", "jump", "joint"}) {
    print_isolated_wraps(method, arguments.divisor);
  }
}

}  // namespace
}  // namespace tofmap::bench

int main(int count, char** words) {
  try {
    tofmap::bench::run(tofmap::bench::read_arguments({words + 1, words + count}));
  } catch (const std::exception& error) {
    std::fprintf(stderr, "bench_filter_accuracy: %s\n", error.what());
    return 2;
  }
  return 0;
}
