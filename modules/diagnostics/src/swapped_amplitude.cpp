// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tofmap/diagnostics/swapped_amplitude.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace tofmap {
namespace {

/// Pairs of images, one of each frequency.
class ImagePairs {
 public:
  void add(const ImageF& a, const ImageF& b) {
    for (Eigen::Index i = 0; i < std::min(a.size(), b.size()); ++i) {
      if (std::isnan(a.data()[i]) || std::isnan(b.data()[i])) continue;
      a_.push_back(a.data()[i]);
      b_.push_back(b.data()[i]);
    }
  }

  /// Share of the pixels that are bright at one frequency and dark at the other, as phases are
  /// where one has wrapped and the other has not. 0 if there are too few pixels.
  double wrapped_share() const {
    constexpr std::size_t enough = 1000;
    if (a_.size() < enough) return 0;
    std::vector<float> sorted = a_;
    const auto nearly_all = static_cast<std::ptrdiff_t>(0.999 * static_cast<double>(a_.size()));
    std::nth_element(sorted.begin(), sorted.begin() + nearly_all, sorted.end());
    const float bright = 0.8F * sorted[static_cast<std::size_t>(nearly_all)];
    const float dark = 0.2F * sorted[static_cast<std::size_t>(nearly_all)];
    std::size_t wrapped = 0;
    for (std::size_t i = 0; i < a_.size(); ++i) {
      const auto [less, more] = std::minmax(a_[i], b_[i]);
      if (more > bright && less < dark) ++wrapped;
    }
    return static_cast<double>(wrapped) / static_cast<double>(a_.size());
  }

 private:
  std::vector<float> a_;
  std::vector<float> b_;
};

}  // namespace

bool looks_like_swapped_amplitude(const std::vector<Frame>& frames) {
  ImagePairs phases;
  ImagePairs amplitudes;
  for (const Frame& frame : frames) {
    if (!frame.has_amplitude() || frame.frequencies() < 2) return false;
    phases.add(frame.phases[0], frame.phases[1]);
    amplitudes.add(frame.amplitudes[0], frame.amplitudes[1]);
  }
  // At 29 and 31 MHz, B has wrapped once more than A in up to a tenth of the pixels of a room.
  constexpr double some = 0.005;
  constexpr double hardly_any = 0.001;
  return amplitudes.wrapped_share() > some && phases.wrapped_share() < hardly_any;
}

std::optional<std::string> swapped_amplitude_warning(const std::vector<Frame>& frames) {
  if (!looks_like_swapped_amplitude(frames)) return std::nullopt;
  return "phases and amplitudes are mixed up: the amplitude images wrap as phases do, and the "
         "phase images do not; exchange their folders, or the images of a device (device.layout)";
}

}  // namespace tofmap
