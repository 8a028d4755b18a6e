// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tofmap/mapping/keyframe_cloud.hpp"

#include <algorithm>
#include <atomic>
#include <list>
#include <mutex>
#include <optional>
#include <utility>

#include <tofmap/core/error.hpp>

namespace tofmap {
namespace {

std::size_t bytes_of(const SurfaceCloud& cloud) {
  return cloud.points.size() * sizeof(SurfacePoint);
}

}  // namespace

/// What the clouds of a shelf share. It lives as long as the last of them.
struct CloudShelf::Stock {
  Stock(const CameraModel& camera, std::size_t budget)
      : rays(pixel_rays(camera)), budget_bytes(budget) {}

  PixelRays rays;
  std::size_t budget_bytes;
  std::mutex mutex;
  std::list<KeyframeCloud::OnShelf*> expanded;  ///< the one that was used last comes first
  std::size_t expanded_bytes = 0;

  void shrink();
};

/// A cloud on a shelf.
struct KeyframeCloud::OnShelf {
  explicit OnShelf(std::shared_ptr<CloudShelf::Stock> of) : stock(std::move(of)) {
    static std::atomic<std::uint64_t> numbers{0};
    number = ++numbers;
  }
  OnShelf(const OnShelf&) = delete;
  OnShelf& operator=(const OnShelf&) = delete;
  ~OnShelf();

  CompactCloud compact() const { return kept ? *kept : read(); }
  void forget();

  std::shared_ptr<CloudShelf::Stock> stock;
  std::uint64_t number = 0;
  std::optional<CompactCloud> kept;           ///< empty if the cloud is read when it is needed
  std::function<CompactCloud()> read;         ///< empty until put_aside()
  std::shared_ptr<const SurfaceCloud> cloud;  ///< expanded; null if it is not in stock->expanded
  std::list<OnShelf*>::iterator place;        ///< in stock->expanded, if `cloud` is not null
};

KeyframeCloud::OnShelf::~OnShelf() {
  const std::scoped_lock lock(stock->mutex);
  if (cloud) forget();
}

/// Takes the cloud off the list of expanded ones. The mutex must be locked.
void KeyframeCloud::OnShelf::forget() {
  stock->expanded.erase(place);
  stock->expanded_bytes -= bytes_of(*cloud);
  cloud = nullptr;
}

/// Forgets expanded clouds beyond the budget, but not the one that was used last. The mutex must be
/// locked.
void CloudShelf::Stock::shrink() {
  while (expanded_bytes > budget_bytes && expanded.size() > 1) expanded.back()->forget();
}

KeyframeCloud::KeyframeCloud(std::shared_ptr<const SurfaceCloud> cloud)
    : plain_(std::move(cloud)) {}

std::shared_ptr<const SurfaceCloud> KeyframeCloud::load() const {
  if (!on_shelf_) return plain_;
  OnShelf& entry = *on_shelf_;
  CloudShelf::Stock& stock = *entry.stock;
  const std::scoped_lock lock(stock.mutex);
  if (entry.cloud) {
    stock.expanded.splice(stock.expanded.begin(), stock.expanded, entry.place);
    return entry.cloud;
  }
  entry.cloud = std::make_shared<const SurfaceCloud>(expand(entry.compact(), stock.rays));
  stock.expanded.push_front(&entry);
  entry.place = stock.expanded.begin();
  stock.expanded_bytes += bytes_of(*entry.cloud);
  std::shared_ptr<const SurfaceCloud> loaded = entry.cloud;
  stock.shrink();
  return loaded;
}

CompactCloud KeyframeCloud::compact() const {
  if (!on_shelf_) throw UsageError("the cloud of a keyframe is on no shelf");
  return on_shelf_->compact();
}

void KeyframeCloud::put_aside(std::function<CompactCloud()> read) const {
  if (!on_shelf_) throw UsageError("the cloud of a keyframe is on no shelf");
  const std::scoped_lock lock(on_shelf_->stock->mutex);
  on_shelf_->read = std::move(read);
  on_shelf_->kept.reset();
}

std::uint64_t KeyframeCloud::number() const { return on_shelf_ ? on_shelf_->number : 0; }

bool KeyframeCloud::is_aside() const { return on_shelf_ && on_shelf_->read; }

std::size_t CloudShelf::default_budget_bytes(const CameraModel& camera) {
  constexpr std::size_t least_bytes = std::size_t{128} << 20U;
  constexpr std::size_t least_clouds = 16;
  const auto pixels = static_cast<std::size_t>(camera.width_px) * camera.height_px;
  return std::max(least_bytes, least_clouds * pixels * sizeof(SurfacePoint));
}

CloudShelf::CloudShelf(const CameraModel& camera, std::size_t budget_bytes)
    : stock_(std::make_shared<Stock>(camera, budget_bytes)) {}

CloudShelf::~CloudShelf() = default;

KeyframeCloud CloudShelf::add(const SurfaceCloud& cloud) {
  KeyframeCloud added;
  added.on_shelf_ = std::make_shared<KeyframeCloud::OnShelf>(stock_);
  added.on_shelf_->kept = compact(cloud);
  return added;
}

KeyframeCloud CloudShelf::add(std::function<CompactCloud()> read) {
  KeyframeCloud added;
  added.on_shelf_ = std::make_shared<KeyframeCloud::OnShelf>(stock_);
  added.on_shelf_->read = std::move(read);
  return added;
}

void CloudShelf::set_budget(std::size_t bytes) {
  const std::scoped_lock lock(stock_->mutex);
  stock_->budget_bytes = bytes;
  stock_->shrink();
}

std::size_t CloudShelf::expanded_bytes() const {
  const std::scoped_lock lock(stock_->mutex);
  return stock_->expanded_bytes;
}

}  // namespace tofmap
