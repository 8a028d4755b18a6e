// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>

#include <tofmap/cloud/compact_cloud.hpp>
#include <tofmap/cloud/surface_cloud.hpp>
#include <tofmap/core/camera.hpp>

namespace tofmap {

class CloudShelf;

/// The cloud of a keyframe. It is either in memory as it is, or on a CloudShelf: compact, in memory
/// or in a file, and expanded when it is needed. Copies refer to the same cloud.
class KeyframeCloud {
 public:
  KeyframeCloud() = default;  ///< no cloud

  /// A cloud that stays in memory as it is.
  KeyframeCloud(std::shared_ptr<const SurfaceCloud> cloud);  // NOLINT(google-explicit-constructor)

  /// The cloud, which stays in memory as long as the caller holds the pointer. Null if there is no
  /// cloud. Throws InputError if the cloud is in a file that cannot be read, or is damaged.
  std::shared_ptr<const SurfaceCloud> load() const;

  /// Whether the cloud is on a CloudShelf.
  bool is_on_shelf() const { return on_shelf_ != nullptr; }

  /// The cloud in compact form. Throws UsageError if the cloud is not on a shelf, InputError as
  /// load() does.
  CompactCloud compact() const;

  /// Tells that the compact cloud can be read again at any time, by `read`, so that it need not
  /// stay in memory. The cloud must be on a shelf.
  void put_aside(std::function<CompactCloud()> read) const;

  /// Whether put_aside() was called for this cloud.
  bool is_aside() const;

  /// A number that no other cloud of this process has. 0 if the cloud is on no shelf.
  std::uint64_t number() const;

 private:
  friend class CloudShelf;
  struct OnShelf;

  std::shared_ptr<const SurfaceCloud> plain_;
  std::shared_ptr<OnShelf> on_shelf_;
};

/// Keeps the clouds of the keyframes of one camera compact. Those that were used last are also kept
/// expanded, as far as a budget allows. Clouds may be loaded from several threads.
class CloudShelf {
 public:
  /// 128 MB, but at least 16 clouds: more than the keyframes around a camera.
  static std::size_t default_budget_bytes(const CameraModel& camera);

  /// `budget_bytes` is the memory that expanded clouds may take which nobody holds.
  CloudShelf(const CameraModel& camera, std::size_t budget_bytes);
  explicit CloudShelf(const CameraModel& camera)
      : CloudShelf(camera, default_budget_bytes(camera)) {}
  ~CloudShelf();

  /// Makes a cloud compact and keeps it. What it loads differs from `cloud` by the errors of
  /// compact(). Throws UsageError as that does.
  KeyframeCloud add(const SurfaceCloud& cloud);

  /// A cloud that is read when it is needed.
  KeyframeCloud add(std::function<CompactCloud()> read);

  /// Changes the budget.
  void set_budget(std::size_t bytes);

  /// Memory of the expanded clouds on the shelf.
  std::size_t expanded_bytes() const;

 private:
  friend class KeyframeCloud;
  struct Stock;

  std::shared_ptr<Stock> stock_;
};

}  // namespace tofmap
