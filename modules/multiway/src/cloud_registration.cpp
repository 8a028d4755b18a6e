// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tofmap/multiway/cloud_registration.hpp"

#include "cloud_graph.hpp"
#include "cloud_pair.hpp"
#include "cloud_remarks.hpp"
#include "cloud_units.hpp"
#include "levelled_cloud.hpp"

#include <algorithm>
#include <array>
#include <optional>

#include <omp.h>

#include <tofmap/core/error.hpp>
#include <tofmap/core/median.hpp>
#include <tofmap/core/side_by_side.hpp>

namespace tofmap {
namespace {

/// How many times smaller voxels may be than those that leave about 5000 points. Smaller voxels
/// would leave hundreds of times as many.
constexpr double most_refinement = 20;

/// Standard deviation of registration errors beyond the covariance, in voxels of the finest level.
constexpr double slack_voxels = 0.5;

/// Converts a pose between centred frames to one between the frames of the clouds.
Pose between_own_frames(const Pose& target_from_source, const LevelledCloud& source,
                        const LevelledCloud& target) {
  return Eigen::Translation3d(target.centre_m) * target_from_source *
         Eigen::Translation3d(-source.centre_m);
}

/// The steps of register_clouds(), with the state that they share.
class Registration {
 public:
  Registration(std::span<const PointSet> clouds, std::span<const std::string> names,
               const CloudRegistrationOptions& options,
               const std::function<bool(int, int)>& keep_going)
      : clouds_(clouds),
        names_(names),
        options_(options),
        keep_going_(keep_going),
        voxels_(side_by_side(static_cast<int>(clouds.size()),
                             [&](int i) { return feature_voxel(clouds[i]); })),
        extents_(side_by_side(
            static_cast<int>(clouds.size()),
            [&](int i) { return extent_voxel(clouds[i], voxels_[static_cast<std::size_t>(i)]); })),
        is_common_(of_common_size(extents_)),
        sensors_(
            side_by_side(static_cast<int>(clouds.size()),
                         [&](int i) { return find_sensor(clouds[i], options.sensor_at_origin); })),
        levels_(clouds.size()) {
    out_.clouds.resize(clouds.size());
    for (std::size_t i = 0; i < clouds.size(); ++i) out_.clouds[i].sensor = sensors_[i];
    const double common_voxel = median_of_common(voxels_);
    out_.voxel_m = options.voxel_m > 0 ? options.voxel_m : common_voxel;
    const double least_m = common_voxel / most_refinement;
    if (out_.voxel_m >= least_m) return;
    throw UsageError(too_fine(out_.voxel_m, least_m));
  }

  CloudRegistration run() {
    align_all_pairs();
    place();
    for (int i = 0; i < static_cast<int>(clouds_.size()) && !out_.interrupted; ++i) {
      if (!cloud(i).is_registered) try_other_units(i);
    }
    place();
    explain();
    finish();
    return std::move(out_);
  }

 private:
  RegisteredCloud& cloud(int i) { return out_.clouds[static_cast<std::size_t>(i)]; }
  std::optional<LevelledCloud>& levels(int i) { return levels_[static_cast<std::size_t>(i)]; }

  double median_of_common(const std::vector<double>& values) const {
    std::vector<double> common;
    for (std::size_t i = 0; i < values.size(); ++i) {
      if (is_common_[i]) common.push_back(values[i]);
    }
    return median(common);
  }

  std::optional<LevelledCloud> levels_with_unit(int i, double unit_m) const {
    const auto index = static_cast<std::size_t>(i);
    return make_levels(clouds_[index], sensors_[index], unit_m, out_.voxel_m);
  }

  bool may_go_on(int done, int all) {
    if (keep_going_ && !keep_going_(done, all)) out_.interrupted = true;
    return !out_.interrupted;
  }

  void align_all_pairs() {
    const int count = static_cast<int>(clouds_.size());
    levels_ = side_by_side(count, [&](int i) {
      return is_common_[static_cast<std::size_t>(i)] ? levels_with_unit(i, 1) : std::nullopt;
    });
    for (int source = 0; source < count; ++source) {
      for (int target = 0; target < source; ++target) {
        if (!levels(source) || !levels(target)) continue;
        out_.pairs.emplace_back();
        out_.pairs.back().source = source;
        out_.pairs.back().target = target;
      }
    }
    const int all = static_cast<int>(out_.pairs.size());
    const int batch = omp_get_max_threads();
    for (int done = 0; done < all; done += batch) {
      if (!may_go_on(done, all)) {
        out_.pairs.resize(static_cast<std::size_t>(done));
        return;
      }
      const auto found = side_by_side(std::min(batch, all - done), [&](int i) {
        const CloudPair& pair = out_.pairs[static_cast<std::size_t>(done + i)];
        return with_indices(align_pair(*levels(pair.source), *levels(pair.target), options_),
                            pair.source, pair.target);
      });
      std::ranges::copy(found, out_.pairs.begin() + done);
    }
    may_go_on(all, all);
  }

  static CloudPair with_indices(CloudPair pair, int source, int target) {
    pair.source = source;
    pair.target = target;
    return pair;
  }

  /// Sets the poses of the clouds to those that fit all pairs best, between centred frames.
  void place() {
    const double slack_m = slack_voxels * out_.voxel_m / 4;
    const auto poses = fit_graph(clouds_.size(), out_.pairs, slack_m, options_.kernel_width);
    for (std::size_t i = 0; i < poses.size(); ++i) {
      out_.clouds[i].is_registered = poses[i].has_value();
      if (poses[i]) out_.clouds[i].common_from_cloud = *poses[i];
    }
  }

  /// Tries whether a cloud that is not registered fits a reference cloud in another unit.
  void try_other_units(int i) {
    const double extent = extents_[static_cast<std::size_t>(i)];
    for (const LengthUnit& unit : likely_units(extent, median_of_common(extents_))) {
      std::optional<LevelledCloud> scaled = levels_with_unit(i, unit.length);
      if (!scaled) continue;
      for (int other = 0; other < static_cast<int>(clouds_.size()); ++other) {
        if (other == i || !levels(other) || !is_reference(other)) continue;
        const CloudPair pair = align_pair(*scaled, *levels(other), options_);
        if (pair.verdict != PairVerdict::registered) continue;
        cloud(i).remark = other_unit(unit, names_[static_cast<std::size_t>(other)]);
        if (!options_.convert_units) return;
        cloud(i).unit_m = unit.length;
        levels(i) = std::move(scaled);
        std::erase_if(out_.pairs, [&](const CloudPair& unscaled) {
          return unscaled.source == i || unscaled.target == i;
        });
        out_.pairs.push_back(with_indices(pair, i, other));
        return;
      }
    }
  }

  /// Whether other units of a cloud are tried with cloud `i`: registered clouds, or if there are
  /// none, all clouds of the common size.
  bool is_reference(int i) {
    return cloud(i).is_registered ||
           (out_.registered() == 0 && is_common_[static_cast<std::size_t>(i)]);
  }

  void explain() {
    for (int i = 0; i < static_cast<int>(clouds_.size()); ++i) {
      const auto index = static_cast<std::size_t>(i);
      if (cloud(i).is_registered || !cloud(i).remark.empty()) continue;
      if (clouds_[index].points.size() < least_oriented_points ||
          (is_common_[index] && !levels(i))) {
        cloud(i).remark = "has too few points on surfaces";
      } else if (!is_common_[index]) {
        cloud(i).remark = odd_size(extents_[index] / median_of_common(extents_));
      } else {
        cloud(i).remark = why_not_registered(i, out_.pairs, names_);
      }
    }
  }

  /// Converts all poses to the frames of the clouds, and records which clouds were registered with
  /// each other.
  void finish() {
    const auto first = std::ranges::find_if(out_.clouds, &RegisteredCloud::is_registered);
    if (first != out_.clouds.end()) {
      const auto index = static_cast<std::size_t>(first - out_.clouds.begin());
      const LevelledCloud& common = *levels_[index];
      for (std::size_t i = 0; i < out_.clouds.size(); ++i) {
        RegisteredCloud& one = out_.clouds[i];
        if (!one.is_registered) continue;
        one.common_from_cloud = between_own_frames(one.common_from_cloud, *levels_[i], common);
      }
    }
    std::ranges::stable_sort(out_.pairs, std::ranges::less(), [](const CloudPair& pair) {
      return std::pair(pair.source, pair.target);
    });
    for (CloudPair& pair : out_.pairs) {
      pair.target_from_source =
          between_own_frames(pair.target_from_source, *levels(pair.source), *levels(pair.target));
      if (pair.verdict == PairVerdict::registered) connect(pair);
    }
  }

  void connect(const CloudPair& pair) {
    for (const auto& [one, other] :
         {std::pair(pair.source, pair.target), std::pair(pair.target, pair.source)}) {
      RegisteredCloud& registered = cloud(one);
      if (!registered.is_registered) continue;
      registered.tied_to.push_back(other);
      std::ranges::sort(registered.tied_to);
      if (pair.fit.inlier_ratio <= registered.inlier_ratio) continue;
      registered.inlier_ratio = pair.fit.inlier_ratio;
      registered.rmse_m = pair.fit.rmse_m;
    }
  }

  std::span<const PointSet> clouds_;
  std::span<const std::string> names_;
  const CloudRegistrationOptions& options_;
  const std::function<bool(int, int)>& keep_going_;
  std::vector<double> voxels_;   ///< feature_voxel() of each cloud, in its own unit
  std::vector<double> extents_;  ///< extent_voxel() of each cloud, in its own unit
  std::vector<bool> is_common_;  ///< of_common_size()
  std::vector<CloudSensor> sensors_;
  std::vector<std::optional<LevelledCloud>> levels_;
  CloudRegistration out_;
};

}  // namespace

std::vector<OptionField<CloudRegistrationOptions>> CloudRegistrationOptions::fields() {
  using O = CloudRegistrationOptions;
  return {
      {"voxel_m", &O::voxel_m, 0, 1000, "m",
       "edge length of the voxels of the coarsest level, where features are matched; 0 chooses it "
       "so that about 5000 points per cloud remain, half of smaller clouds"},
      {"method", &O::method, 0, 0, "",
       "how poses are refined; the methods of PCL are for comparison"},
      {"sensor_at_origin", &O::sensor_at_origin, 0, 0, "",
       "whether the origin of each cloud is the position of its sensor, so that free space is "
       "known; infer decides by the pattern of the points"},
      {"min_overlap", &O::min_overlap, 0, 1, "",
       "smallest share of one of two clouds that must be near the other"},
      {"min_inlier_ratio", &O::min_inlier_ratio, 0, 1, "",
       "smallest share of the near points that must lie on the surface of the other cloud, for "
       "complete overlap; up to 0.15 more for smaller overlap"},
      {"min_direction_share", &O::min_direction_share, 0, 1, "",
       "smallest share of the observations that must constrain each direction of motion"},
      {"kernel_width", &O::kernel_width, 0.5, 100, "",
       "width of the kernel that down-weights pairs that contradict others, in standard "
       "deviations"},
      {"convert_units", &O::convert_units, 0, 0, "",
       "scales a cloud that is in another unit than the others and registers it, instead of "
       "leaving it out"},
  };
}

std::span<const NamedValue<PairVerdict>> named_values(PairVerdict) {
  static constexpr std::array<NamedValue<PairVerdict>, 8> verdicts{
      {{"registered", PairVerdict::registered},
       {"few_matches", PairVerdict::few_matches},
       {"low_overlap", PairVerdict::low_overlap},
       {"low_inliers", PairVerdict::low_inliers},
       {"contradicted", PairVerdict::contradicted},
       {"degenerate", PairVerdict::degenerate},
       {"ambiguous", PairVerdict::ambiguous},
       {"disagrees", PairVerdict::disagrees}}};
  return verdicts;
}

int CloudRegistration::registered() const {
  return static_cast<int>(std::ranges::count_if(clouds, &RegisteredCloud::is_registered));
}

CloudRegistration register_clouds(std::span<const PointSet> clouds,
                                  std::span<const std::string> names,
                                  const CloudRegistrationOptions& options,
                                  const std::function<bool(int, int)>& keep_going) {
  if (clouds.size() < 2 || clouds.size() != names.size()) {
    throw UsageError("registration needs at least two clouds, and a name for each");
  }
  return Registration(clouds, names, options, keep_going).run();
}

}  // namespace tofmap
