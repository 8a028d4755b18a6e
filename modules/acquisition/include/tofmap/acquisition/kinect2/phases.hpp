// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>

#include <tofmap/acquisition/kinect2/p0_tables.hpp>
#include <tofmap/acquisition/kinect2/packet.hpp>
#include <tofmap/core/image.hpp>

namespace tofmap::kinect2 {

/// Factors of the amplitudes, in the order of `frequencies_hz`, which make the amplitudes of the
/// same surface comparable: the camera measures less contrast at higher frequencies. Source:
/// libfreenect2, depth_packet_processor.cpp.
inline constexpr std::array<double, 3> amplitude_factors{1.322581, 1, 1.612903};

/// The amplitude of a saturated pixel. It is larger than all others, which are at most 35 100.
inline constexpr float saturated_amplitude = 65535;

/// Phases and amplitudes of one frame, one image a frequency in the order of `frequencies_hz`. Rows
/// and columns are those of Measurements.
struct Phases {
  std::array<ImageF, 3> phase;       ///< cycles, in [0, 1); NaN without signal or if saturated
  std::array<ImageF, 3> amplitude;   ///< at least 0; `saturated_amplitude` if saturated
  std::array<ImageU8, 3> saturated;  ///< 1 if any step of the frequency was saturated, otherwise 0
};

/// Phase and amplitude of every pixel from three steps.
///
/// The camera's model, with range r (half of the light's path), wavelength λ = c / 2f, the phase
/// offset p = -2π `cycles_per_p0_unit` · table and φ_k = 2πk / 3, is
///
///     m_k = a cos(2π r / λ + p + φ_k),   k = 0, 1, 2.
///
/// Since Σ cos²(θ + φ_k) = Σ sin²(θ + φ_k) = 3/2, and the sums of their products are 0,
///
///     I = Σ m_k cos(p + φ_k) = 3/2 a cos(2π r / λ),
///     Q = -Σ m_k sin(p + φ_k) = 3/2 a sin(2π r / λ),
///
/// so that atan2(Q, I) / 2π is the phase φ in cycles, r = (φ + n) λ, and 2/3 √(I² + Q²) is a. The
/// amplitude is a times the frequency's factor. A constant that all three steps share has no
/// effect. The phase is computed as atan2 of I and Q at p = 0, minus p, which is the same.
///
/// A pixel without signal (I = Q = 0) has no phase and the amplitude 0.
///
/// Source: libfreenect2, cpu_depth_packet_processor.cpp, which cites US patent 8,587,771.
///
/// Throws UsageError if images do not have 424 rows and 512 columns.
Phases phases_from_measurements(const Measurements& measurements, const P0Tables& p0);

/// The measurements that have these phases and amplitudes: the inverse of
/// phases_from_measurements(), rounded to whole units. encode_packet() rounds them further.
///
/// A pixel without a phase, or whose amplitude is not above 0, measures 0 in all steps. A pixel
/// whose amplitude is `saturated_amplitude` or larger is saturated in all steps, and a step that
/// exceeds the scale of the measurements is saturated. Columns 0 and 511 are lost in a packet.
///
/// Throws UsageError if images do not have 424 rows and 512 columns.
Measurements measurements_from_phases(const std::array<ImageF, 3>& phase,
                                      const std::array<ImageF, 3>& amplitude, const P0Tables& p0);

}  // namespace tofmap::kinect2
