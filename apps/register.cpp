// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "command.hpp"
#include "console/interruption.hpp"
#include "console/progress.hpp"
#include "options/options.hpp"
#include "output/json_text.hpp"
#include "output/output_folder.hpp"

#include <cstdio>
#include <memory>
#include <utility>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <tofmap/cloud/downsample.hpp>
#include <tofmap/cloud/point_file.hpp>
#include <tofmap/core/error.hpp>
#include <tofmap/multiway/cloud_registration.hpp>

namespace tofmap::app {
namespace {

using nlohmann::ordered_json;

struct RegisterArguments {
  std::vector<std::filesystem::path> clouds;
  std::filesystem::path out;
  CommonArguments common;
};

/// The clouds that could be read, with their names, and the files that could not.
struct Input {
  std::vector<PointSet> clouds;
  std::vector<std::string> names;
  std::vector<std::size_t> places;  ///< index of each cloud among all files
  std::vector<std::pair<std::size_t, std::string>> damages;  ///< index among all files, and reason
  std::vector<std::string> files;                            ///< all files, in the order given
};

/// Reads a cloud without its points at a limit of range. Throws InputError if no others are left.
PointSet read_surfaces(const std::filesystem::path& file, SensorAtOrigin at_origin) {
  PointSet cloud = read_points(file);
  leave_out_range_limit(cloud, at_origin);
  if (!cloud.limit) return cloud;
  const std::string named = fmt::format("{}: {} points at a constant greatest range of {:.2f}",
                                        file.string(), cloud.limit->points, cloud.limit->range);
  if (cloud.points.empty()) {
    throw InputError(named + ", and no others; does the file hold the surfaces?");
  }
  std::fprintf(stderr, "tofmap: %s are left out\n", named.c_str());
  return cloud;
}

void read_cloud(const std::filesystem::path& file, SensorAtOrigin at_origin, Input& input) {
  const std::size_t place = input.files.size();
  input.files.push_back(file.string());
  try {
    input.clouds.push_back(read_surfaces(file, at_origin));
  } catch (const InputError& error) {
    input.damages.emplace_back(place, error.what());
    return;
  }
  const std::size_t strays = remove_strays(input.clouds.back().points);
  if (strays > 0) {
    std::fprintf(stderr, "tofmap: %s: %zu points far from all others are left out\n", file.c_str(),
                 strays);
  }
  input.names.push_back(file.string());
  input.places.push_back(place);
}

/// Reads all clouds. Files that cannot be read are left out and named on stderr. Throws InputError,
/// with the reason for the first, if these are more than half, or if fewer than two clouds are
/// left.
Input read_clouds(const std::vector<std::filesystem::path>& files, SensorAtOrigin at_origin) {
  if (files.size() < 2) throw UsageError("register: needs at least two clouds");
  Input input;
  for (const std::filesystem::path& file : files) read_cloud(file, at_origin, input);
  if (2 * input.damages.size() > files.size() || input.clouds.size() < 2) {
    throw InputError(input.damages.front().second);
  }
  for (const auto& [place, damage] : input.damages) {
    std::fprintf(stderr, "tofmap: left out: %s\n", damage.c_str());
  }
  return input;
}

/// The elements of a matrix, row by row.
ordered_json matrix_json(const Eigen::Matrix4d& matrix) {
  ordered_json numbers = ordered_json::array();
  for (int row = 0; row < 4; ++row) {
    for (int col = 0; col < 4; ++col) numbers.push_back(matrix(row, col));
  }
  return numbers;
}

ordered_json vector_json(const Eigen::Vector3d& vector) {
  return {vector.x(), vector.y(), vector.z()};
}

/// The transform of a cloud into the common frame, including the scale of its unit.
Eigen::Matrix4d scaled_transform(const RegisteredCloud& cloud) {
  Eigen::Matrix4d matrix = cloud.common_from_cloud.matrix();
  matrix.topLeftCorner<3, 3>() *= cloud.unit_m;
  return matrix;
}

ordered_json registered_json(const Input& input, std::size_t i, const RegisteredCloud& cloud) {
  ordered_json one;
  one["path"] = input.names[i];
  one["transform"] =
      cloud.is_registered ? matrix_json(scaled_transform(cloud)) : ordered_json(nullptr);
  one["inlier_share"] = cloud.inlier_ratio;
  one["rmse_m"] = cloud.is_registered ? ordered_json(cloud.rmse_m) : ordered_json(nullptr);
  one["converged"] = cloud.is_registered;
  one["tied_to"] = ordered_json::array();
  for (const int other : cloud.tied_to) {
    one["tied_to"].push_back(input.names[static_cast<std::size_t>(other)]);
  }
  if (cloud.unit_m != 1) one["scale"] = cloud.unit_m;
  if (!cloud.remark.empty()) one["remark"] = cloud.remark;
  return one;
}

/// The entry of a file that could not be read, with the keys of a cloud that could not be
/// registered.
ordered_json damaged_json(const std::string& file, const std::string& damage) {
  return {{"path", file},      {"transform", nullptr}, {"inlier_share", 0.0},
          {"rmse_m", nullptr}, {"converged", false},   {"tied_to", ordered_json::array()},
          {"damage", damage}};
}

/// One entry per file, in the order given.
ordered_json transforms_json(const Input& input, const CloudRegistration& registration) {
  std::vector<ordered_json> by_place(input.files.size());
  for (std::size_t i = 0; i < input.names.size(); ++i) {
    by_place[input.places[i]] = registered_json(input, i, registration.clouds[i]);
  }
  for (const auto& [place, damage] : input.damages) {
    by_place[place] = damaged_json(input.files[place], damage);
  }
  return {{"clouds", by_place}};
}

/// What is known of a cloud without regard to the others.
ordered_json cloud_json(const Input& input, std::size_t i, const RegisteredCloud& cloud) {
  ordered_json json;
  json["path"] = input.names[i];
  json["points"] = input.clouds[i].points.size();
  json["sensor"] = name_of(cloud.sensor.source);
  json["sensor_position"] = cloud.sensor.position ? vector_json(*cloud.sensor.position) : nullptr;
  const std::optional<RangeLimit>& limit = input.clouds[i].limit;
  if (limit) {
    json["range_limit"] = {{"points_left_out", limit->points}, {"range", limit->range}};
  }
  return json;
}

ordered_json pair_json(const Input& input, const CloudPair& pair) {
  ordered_json json;
  json["source"] = input.names[static_cast<std::size_t>(pair.source)];
  json["target"] = input.names[static_cast<std::size_t>(pair.target)];
  json["verdict"] = name_of(pair.verdict);
  json["matches"] = pair.matches;
  json["support"] = pair.support;
  json["overlap"] = pair.fit.overlap;
  json["inlier_ratio"] = pair.fit.inlier_ratio;
  json["rmse_m"] = pair.fit.rmse_m;
  json["tested_views"] = pair.tested_views;
  json["free_space_violation"] = pair.free_space_violation;
  json["window_share"] = pair.window_share;
  json["runner_up"] = pair.runner_up;
  json["direction_share"] = pair.direction_share;
  json["mahalanobis_distance"] = pair.mahalanobis_distance;
  json["target_from_source"] = matrix_json(pair.target_from_source.matrix());
  return json;
}

ordered_json report_json(const Input& input, const CloudRegistration& registration) {
  ordered_json report;
  report["summary"] = {{"clouds", input.files.size()},
                       {"damaged", input.damages.size()},
                       {"registered", registration.registered()},
                       {"pairs", registration.pairs.size()},
                       {"voxel_m", registration.voxel_m},
                       {"interrupted", registration.interrupted}};
  report["clouds"] = ordered_json::array();
  for (std::size_t i = 0; i < input.names.size(); ++i) {
    report["clouds"].push_back(cloud_json(input, i, registration.clouds[i]));
  }
  report["pairs"] = ordered_json::array();
  for (const CloudPair& pair : registration.pairs) {
    report["pairs"].push_back(pair_json(input, pair));
  }
  return report;
}

/// The points of the registered clouds in the common frame, by index of the file. Empty for the
/// other files.
std::vector<std::vector<Eigen::Vector3d>> merged(const Input& input,
                                                 const CloudRegistration& registration) {
  std::vector<std::vector<Eigen::Vector3d>> out(input.files.size());
  for (std::size_t i = 0; i < input.clouds.size(); ++i) {
    const RegisteredCloud& cloud = registration.clouds[i];
    if (!cloud.is_registered) continue;
    for (const Eigen::Vector3d& point : input.clouds[i].points) {
      out[input.places[i]].push_back(cloud.common_from_cloud * (cloud.unit_m * point));
    }
  }
  return out;
}

/// Prints the remarks about clouds on stderr, so that they are seen if stdout is redirected.
void print_remarks(const Input& input, const CloudRegistration& registration) {
  for (std::size_t i = 0; i < input.names.size(); ++i) {
    const RegisteredCloud& cloud = registration.clouds[i];
    if (cloud.remark.empty()) continue;
    std::fprintf(stderr, "tofmap: %s: %s%s\n", input.names[i].c_str(),
                 cloud.is_registered ? "" : "not registered: ", cloud.remark.c_str());
  }
}

int run_register(const RegisterArguments& arguments) {
  ProgramOptions options;
  const OptionTable table = arguments.common.resolve("register", options);
  OutputFolder out(arguments.out);
  const Input input = read_clouds(arguments.clouds, options.cloud_registration.sensor_at_origin);
  CloudRegistration registration;
  {
    std::optional<Progress> progress;
    registration = register_clouds(
        input.clouds, input.names, options.cloud_registration, [&](int done, int all) {
          if (!progress) progress.emplace("registering pair", all, arguments.common.quiet);
          progress->show(done);
          return !is_interrupted();
        });
  }
  print_remarks(input, registration);
  out.write_text("transforms.json", json_text(transforms_json(input, registration)));
  out.write_text("report.json", json_text(report_json(input, registration)));
  out.write_text("options.yaml", table.to_yaml(false));
  if (registration.registered() > 0) {
    write_labelled_points(out.path() / "merged.ply", merged(input, registration));
  }
  out.commit(registration.interrupted ? Completeness::interrupted : Completeness::whole);
  if (!arguments.common.quiet) {
    std::printf("%d of %zu clouds registered\n", registration.registered(), input.files.size());
    if (registration.registered() > 0) {
      std::printf("merged: %s, transforms beside it\n", (out.final_path() / "merged.ply").c_str());
    }
  }
  if (registration.interrupted) {
    std::fprintf(stderr, "tofmap: interrupted after %zu pairs of clouds\n",
                 registration.pairs.size());
    return exit_status::interrupted;
  }
  if (registration.registered() == 0) {
    throw InputError("no two of the clouds could be registered; report.json in " +
                     out.final_path().string() + " has the measures of each pair");
  }
  return exit_status::done;
}

}  // namespace

void add_register_command(CLI::App& program, Outcome& outcome) {
  auto arguments = std::make_shared<RegisterArguments>();
  CLI::App* app =
      program.add_subcommand("register", "register clouds of one scene in a common frame");
  app->add_option("CLOUD", arguments->clouds, "PLY, PCD or VTK files, at least two, in any order")
      ->required();
  app->add_option("--out", arguments->out, "folder for the result")->required();
  arguments->common.add_to(*app);
  app->callback([arguments, &outcome] { outcome.status = run_register(*arguments); });
}

}  // namespace tofmap::app
