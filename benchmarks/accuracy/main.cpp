// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

// Prints the share of wrong wraps of each unwrapping method, as Markdown tables
// (docs/comparison.md):
//
//     bench_unwrap_accuracy [--divide N] [SEQ …]        all methods on scenes; parts of joint
//     bench_unwrap_accuracy --departures [--divide N] [SEQ …]
//                                                       each departure of jump from the paper
//     bench_unwrap_accuracy --frozen [--divide N]       all methods on frozen data (frozen.hpp)
//     bench_unwrap_accuracy --grid [--frozen] [--half] [--quick] [--csv FILE]
//                                                       all methods under camera errors
//
// SEQ are recordings with range_truth/, which are added to the simulated ones. N divides the number
// of runs.

#include "cases.hpp"
#include "grid_report.hpp"
#include "tables.hpp"

#include <cstdio>
#include <filesystem>
#include <vector>

#include <CLI/CLI.hpp>

namespace tofmap::accuracy {
namespace {

struct Arguments {
  std::vector<std::filesystem::path> recordings;
  int divisor = 1;
  bool only_departures = false;
  bool is_grid = false;
  GridSettings grid;
  std::filesystem::path csv;
};

void print_tables(const Arguments& arguments) {
  std::printf("%s\n", describe_runs(arguments.divisor).c_str());
  const bool frozen = arguments.grid.frozen;
  std::vector<Case> cases = arguments.only_departures ? paper_cases(arguments.divisor)
                            : frozen                  ? frozen_cases(arguments.divisor)
                                                      : development_cases(arguments.divisor);
  for (const auto& folder : arguments.recordings) {
    cases.push_back(recorded_case(folder, arguments.divisor));
  }
  if (arguments.only_departures) return print_departure_tables(cases);
  print_method_tables(cases);
  if (!frozen) print_ablation_table(cases);
}

void run(const Arguments& arguments) {
  if (!arguments.is_grid) return print_tables(arguments);
  const Grid grid = measure_grid(arguments.grid);
  print_grid(grid);
  if (!arguments.csv.empty()) write_grid_csv(grid, arguments.csv);
}

}  // namespace
}  // namespace tofmap::accuracy

int main(int count, char** values) {
  tofmap::accuracy::Arguments arguments;
  CLI::App app("Measures the wrong wraps of every unwrapping method");
  app.add_option("SEQ", arguments.recordings, "more recordings, with range_truth/");
  app.add_option("--divide", arguments.divisor, "divide the number of runs by this")
      ->check(CLI::PositiveNumber);
  auto* frozen = app.add_flag("--frozen", arguments.grid.frozen,
                              "use frozen data instead of development data");
  auto* grid = app.add_flag("--grid", arguments.is_grid, "measure a grid of camera errors");
  app.add_flag("--departures", arguments.only_departures,
               "measure each departure of jump from the paper")
      ->excludes(frozen)
      ->excludes(grid);
  app.add_flag("--half", arguments.grid.half,
               "halve the width and height of the images of the grid")
      ->needs(grid);
  app.add_flag("--quick", arguments.grid.quick, "measure a small grid")->needs(grid);
  app.add_option("--csv", arguments.csv, "write all rows of the grid to this file")->needs(grid);
  CLI11_PARSE(app, count, values);
  try {
    tofmap::accuracy::run(arguments);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
  return 0;
}
