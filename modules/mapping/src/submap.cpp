// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tofmap/mapping/submap.hpp"

#include <utility>

namespace tofmap {

SubmapSurface::SubmapSurface(SurfaceMap surface) : shared_(std::make_shared<Shared>()) {
  shared_->surface = std::make_shared<SurfaceMap>(std::move(surface));
}

std::shared_ptr<const SurfaceMap> SubmapSurface::load() const {
  if (is_aside()) return std::make_shared<const SurfaceMap>(shared_->read());
  return shared_->surface;
}

SurfaceMap& SubmapSurface::change() {
  if (is_aside()) {
    *this = SubmapSurface(shared_->read());
  } else if (shared_.use_count() > 1 || shared_->surface.use_count() > 1) {
    *this = SubmapSurface(SurfaceMap(*shared_->surface));
  }
  return *shared_->surface;
}

void SubmapSurface::put_aside(std::function<SurfaceMap()> read) const {
  shared_->size = size();
  shared_->revision = revision();
  shared_->read = std::move(read);
  shared_->surface = nullptr;
}

std::size_t SubmapSurface::size() const {
  return is_aside() ? shared_->size : shared_->surface->size();
}

std::uint64_t SubmapSurface::revision() const {
  return is_aside() ? shared_->revision : shared_->surface->revision();
}

}  // namespace tofmap
