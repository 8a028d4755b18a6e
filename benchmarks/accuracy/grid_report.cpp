// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "grid_report.hpp"

#include "conditions.hpp"
#include "text.hpp"

#include <algorithm>
#include <array>
#include <cstdio>
#include <fstream>
#include <map>

#include <fmt/format.h>

#include <tofmap/core/error.hpp>

namespace tofmap::accuracy {
namespace {

std::string mean_and_worst(const Score& score) {
  return fmt::format("{:.2f} / {:.1f}", score.wrong_percent(), score.worst_percent());
}

/// The number of rows that meet a condition.
struct Kept {
  int holds = 0;
  int without_allowance = 0;
  int all = 0;

  void add(const Check& check) {
    if (!check.applies) return;
    ++all;
    if (check.holds()) ++holds;
    if (check.value <= check.limit) ++without_allowance;
  }
};

void print_kept(const char* name, const Kept& kept) {
  std::printf("| %s | %s | %s |\n", name, count_of(kept.holds, kept.all).c_str(),
              count_of(kept.without_allowance, kept.all).c_str());
}

/// The rows of one kind and size of error, over all scenes and seeds.
struct Group {
  std::string name;
  Score pixel, jump, joint, without_errors;
  double worst_calibration_percent = 0;
  Kept kept;

  void add(const GridRow& row, const Checks& checks) {
    add_score(row.pixel, pixel);
    add_score(row.jump, jump);
    add_score(row.joint, joint);
    add_score(row.joint_without_errors, without_errors);
    worst_calibration_percent =
        std::max(worst_calibration_percent, row.joint.calibration.error_percent());
    for (const Check& check : checks) kept.add(check);
  }
};

/// The name of the group of a combination. All pairs of errors are one group, as are all random
/// combinations; the CSV file has them one by one.
std::string group_name(const Combination& combination) {
  const bool is_many = combination.kind == "two errors" || combination.kind.starts_with("drawn");
  if (!is_many) return combination.kind + ' ' + combination.size;
  return combination.kind == "two errors" ? "every two errors at their largest"
                                          : "all errors, " + combination.kind;
}

/// The groups of rows, in the order of their first rows.
std::vector<Group> group_rows(const Grid& grid, const std::vector<Checks>& checks) {
  std::vector<Group> groups;
  for (std::size_t i = 0; i < grid.rows.size(); ++i) {
    const std::string name = group_name(grid.combinations[grid.rows[i].combination]);
    auto group = std::ranges::find(groups, name, &Group::name);
    if (group == groups.end()) {
      groups.emplace_back().name = name;
      group = groups.end() - 1;
    }
    group->add(grid.rows[i], checks[i]);
  }
  return groups;
}

void print_groups(const std::vector<Group>& groups) {
  std::printf(
      "\n| wrong wraps, %%, mean / worst frame | pixel | jump | joint | joint without the errors | "
      "joint, surest 90 %% | without the errors | largest calibration error, %% | conditions kept "
      "|\n|---|---|---|---|---|---|---|---|---|\n");
  for (const Group& group : groups) {
    std::printf("| %s | %s | %s | %s | %s | %.3f | %.3f | %.1f | %s |\n", group.name.c_str(),
                mean_and_worst(group.pixel).c_str(), mean_and_worst(group.jump).c_str(),
                mean_and_worst(group.joint).c_str(), mean_and_worst(group.without_errors).c_str(),
                group.joint.sure_wrong_percent(), group.without_errors.sure_wrong_percent(),
                group.worst_calibration_percent,
                count_of(group.kept.holds, group.kept.all).c_str());
  }
}

std::string full_name(const Grid& grid, const GridRow& row) {
  const Combination& combination = grid.combinations[row.combination];
  return fmt::format("{}, seed {}: {} {}", row.scene.c_str(), row.seed, combination.kind.c_str(),
                     combination.size.c_str());
}

void print_conditions(const std::vector<Checks>& checks) {
  std::printf("\n| condition | rows that keep it | without the allowance |\n|---|---|---|\n");
  Kept all;
  for (int c = 0; c < condition_count; ++c) {
    Kept kept;
    for (const Checks& row : checks) {
      kept.add(row[static_cast<std::size_t>(c)]);
      all.add(row[static_cast<std::size_t>(c)]);
    }
    print_kept(name_of(static_cast<Condition>(c)), kept);
  }
  print_kept("all", all);
}

/// Prints the share of right wraps at each confidence, over all rows.
void print_reliability(const Grid& grid) {
  Calibration all;
  for (const GridRow& row : grid.rows) all.add(row.joint.calibration);
  std::printf(
      "\n| confidence of joint from | mean | right wraps, %% | pixels, %% |\n|---|---|---|---|\n");
  for (const Calibration::Bin& bin : all.reliability()) {
    std::printf("| %g | %.5f | %.3f | %.2f |\n", bin.least_confidence, bin.mean_confidence,
                100 * bin.right_share, 100 * bin.pixel_share);
  }
}

struct Failure {
  const GridRow* row;
  Condition condition;
  Check check;
};

/// Prints the three rows that miss each condition by most.
void print_failures(const Grid& grid, const std::vector<Checks>& checks) {
  constexpr std::size_t shown = 3;
  std::printf(
      "\n| furthest from its condition | value, %% | allowed, %% | condition |\n"
      "|---|---|---|---|\n");
  for (int c = 0; c < condition_count; ++c) {
    std::vector<Failure> failures;
    for (std::size_t i = 0; i < grid.rows.size(); ++i) {
      const Check& check = checks[i][static_cast<std::size_t>(c)];
      if (!check.holds()) failures.push_back({&grid.rows[i], static_cast<Condition>(c), check});
    }
    std::ranges::stable_sort(failures, std::ranges::greater(),
                             [](const Failure& f) { return f.check.excess(); });
    if (failures.size() > shown) failures.resize(shown);
    for (const Failure& failure : failures) {
      std::printf("| %s | %.3f | %.3f | %s |\n", full_name(grid, *failure.row).c_str(),
                  failure.check.value, failure.check.limit + failure.check.allowance,
                  name_of(failure.condition));
    }
  }
}

void write_score(std::ofstream& file, const Score& score) {
  file << fmt::format(",{:.4f},{:.4f},{:.4f},{:.4f}", score.wrong_percent(), score.worst_percent(),
                      score.sure_wrong_percent(), score.calibration.error_percent());
}

constexpr std::array<const char*, condition_count> csv_conditions{
    "no_worse_than_simple", "mean_kept", "worst_kept", "surest_kept", "calibrated"};

void write_csv_header(std::ofstream& file) {
  file << "scene,seed,kind,size,offset_m,periodic_a_m,periodic_b_m,amplitude_error_a_m,"
          "amplitude_error_b_m,pattern_m,delay_share,ambient_noise,noise_m";
  for (const char* method : {"pixel", "jump", "joint", "joint_without_errors"}) {
    for (const char* figure : {"wrong", "worst", "surest_wrong", "calibration_error"}) {
      file << ',' << method << '_' << figure << "_percent";
    }
  }
  for (const char* condition : csv_conditions) {
    file << ',' << condition << ',' << condition << "_allowed_percent";
  }
  file << '\n';
}

}  // namespace

void print_grid(const Grid& grid) {
  std::vector<Checks> checks;
  for (const GridRow& row : grid.rows) checks.push_back(check_row(grid, row));
  std::printf("\nEach row: %d runs of %d consecutive frames, one Unwrapper each.\n", grid.runs.runs,
              grid.runs.frames);
  print_groups(group_rows(grid, checks));
  print_conditions(checks);
  print_failures(grid, checks);
  print_reliability(grid);
}

void write_grid_csv(const Grid& grid, const std::filesystem::path& path) {
  std::ofstream file(path);
  write_csv_header(file);
  for (const GridRow& row : grid.rows) {
    const Combination& combination = grid.combinations[row.combination];
    const CameraErrors& e = combination.errors;
    file << row.scene << ',' << row.seed << ',' << '"' << combination.kind << "\",\""
         << combination.size << '"';
    for (const double value :
         {e.offset_m, e.periodic_a_m, e.periodic_b_m, e.amplitude_error_a_m, e.amplitude_error_b_m,
          e.pattern_m, e.delay_share, e.ambient_noise, e.noise_m}) {
      file << fmt::format(",{:.5g}", value);
    }
    for (const Score* score : {&row.pixel, &row.jump, &row.joint, &row.joint_without_errors}) {
      write_score(file, *score);
    }
    for (const Check& check : check_row(grid, row)) {
      const char* verdict = !check.applies ? "" : check.holds() ? "yes" : "no";
      file << ',' << verdict << fmt::format(",{:.4f}", check.limit + check.allowance);
    }
    file << '\n';
  }
  file.close();
  if (!file) throw InputError(path.string() + ": cannot be written");
}

}  // namespace tofmap::accuracy
