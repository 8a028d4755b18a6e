// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tables.hpp"

#include "text.hpp"
#include "variants.hpp"

#include <cstdio>
#include <functional>
#include <string>

#include <fmt/format.h>

namespace tofmap::accuracy {
namespace {

/// The scores of one variant for each case.
using Column = std::vector<Score>;
using Cell = std::function<std::string(const Score&)>;

void print_table(const std::string& title, const std::vector<Case>& cases,
                 const std::vector<Variant>& variants, const std::vector<Column>& columns,
                 const Cell& cell) {
  std::printf("\n| %s |", title.c_str());
  for (const Variant& variant : variants) std::printf(" %s |", variant.name.c_str());
  std::printf("\n|---|");
  for (std::size_t v = 0; v < variants.size(); ++v) std::printf("---|");
  std::printf("\n");
  for (std::size_t c = 0; c < cases.size(); ++c) {
    std::printf("| %s |", cases[c].name.c_str());
    for (const Column& column : columns) std::printf(" %s |", cell(column[c]).c_str());
    std::printf("\n");
  }
  std::fflush(stdout);
}

std::vector<Column> score_all(const std::vector<Case>& cases,
                              const std::vector<Variant>& variants) {
  std::vector<Column> columns;
  for (const Variant& variant : variants) {
    columns.emplace_back();
    for (const Case& data : cases) columns.back().push_back(score_case(data, variant));
  }
  return columns;
}

std::string wrong_wraps(const Score& s) {
  return fmt::format("{:.2f} / {:.1f}", s.wrong_percent(), s.worst_percent());
}

std::string converged_frames(const Score& s) {
  return fmt::format("{:.0f}", s.converged_percent());
}

}  // namespace

void print_method_tables(const std::vector<Case>& cases) {
  const std::vector<Variant> all = methods();
  const std::vector<Column> scores = score_all(cases, all);
  print_table("wrong wraps, %, mean / worst frame", cases, all, scores, wrong_wraps);
  print_table("wrong among the surest 90 %, %", cases, all, scores,
              [](const Score& s) { return fmt::format("{:.3f}", s.sure_wrong_percent()); });
  print_table("calibration error of the confidence, %", cases, all, scores,
              [](const Score& s) { return fmt::format("{:.1f}", s.calibration.error_percent()); });
  print_table("pixels with a range, %", cases, all, scores,
              [](const Score& s) { return fmt::format("{:.1f}", s.coverage_percent()); });
  print_table("error of right ranges, RMS, cm", cases, all, scores,
              [](const Score& s) { return fmt::format("{:.1f}", 100 * s.range_rmse_m()); });
  print_table("milliseconds per frame, one core", cases, all, scores,
              [](const Score& s) { return fmt::format("{:.1f}", s.milliseconds()); });
}

void print_ablation_table(const std::vector<Case>& cases) {
  const std::vector<Variant> without = ablations();
  print_table("wrong wraps, %, mean / worst frame", cases, without, score_all(cases, without),
              wrong_wraps);
}

void print_departure_tables(const std::vector<Case>& cases) {
  for (const std::vector<Variant>& variants : {departures(), returns()}) {
    const std::vector<Column> scores = score_all(cases, variants);
    print_table("wrong wraps, %, mean / worst frame", cases, variants, scores, wrong_wraps);
    print_table("frames that converge, %", cases, variants, scores, converged_frames);
  }
}

}  // namespace tofmap::accuracy
