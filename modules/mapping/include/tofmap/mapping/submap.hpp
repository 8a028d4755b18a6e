// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>

#include <tofmap/mapping/surface_map.hpp>

namespace tofmap {

/// The surface of a submap, in memory or in the file of its map. Copies share what is in memory
/// until one of them is changed. Copies must not be used by several threads at the same time.
class SubmapSurface {
 public:
  SubmapSurface(SurfaceMap surface);  // NOLINT(google-explicit-constructor)

  /// The surface, which stays in memory as long as the caller holds the pointer. Throws InputError
  /// if the surface is in a file that cannot be read, or is damaged.
  std::shared_ptr<const SurfaceMap> load() const;

  /// The surface, to be changed. It stays in memory until put_aside(). Throws as load() does. The
  /// reference is valid until the next call of another function than size() and revision().
  SurfaceMap& change();

  /// Tells that the surface can be read again at any time, by `read`, so that it need not stay in
  /// memory.
  void put_aside(std::function<SurfaceMap()> read) const;

  /// Whether the surface is read when it is needed.
  bool is_aside() const { return shared_->surface == nullptr; }

  /// Number of voxels.
  std::size_t size() const;

  /// SurfaceMap::revision() of the surface when it was changed last.
  std::uint64_t revision() const;

 private:
  /// What copies share.
  struct Shared {
    std::shared_ptr<SurfaceMap> surface;  ///< null if it is read when it is needed
    std::function<SurfaceMap()> read;     ///< empty if the surface is in memory
    std::size_t size = 0;                 ///< of a surface that is read when it is needed
    std::uint64_t revision = 0;           ///< the same
  };

  std::shared_ptr<Shared> shared_;
};

/// A submap: the surface seen from near one keyframe, the anchor, in the frame of the anchor.
struct Submap {
  int anchor = 0;  ///< id of a keyframe
  SubmapSurface surface;
};

}  // namespace tofmap
