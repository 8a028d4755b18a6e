// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <functional>

#include <tofmap/acquisition/kinect2/p0_tables.hpp>
#include <tofmap/acquisition/kinect2/packet.hpp>
#include <tofmap/core/trajectory.hpp>
#include <tofmap/simulation/simulator.hpp>

namespace tofmap {

/// Amplitude in a packet, `a` in kinect2/phases.hpp, of a simulated amplitude of 1. A surface of
/// reflectance 0.5 that faces the camera at 5 m then has an amplitude of 60 at 16 MHz. One of
/// reflectance 0.8 at less than 0.38 m exceeds the largest magnitude of a packet, 16320, and is
/// saturated there.
inline constexpr double packet_units_per_amplitude = 0.5;

/// The simulator's options for a Kinect v2, with the camera of kinect2::typical_intrinsics, but
/// with its optical axis in the image centre and without distortion. The same values, with their
/// sources, are in configs/cameras/kinect2.yaml.
SimulatorOptions kinect2_simulator_options();

/// Throws UsageError, which says what a packet can hold, unless a simulated sensor has 512 x 424
/// pixels and the frequencies 80, 16 and 120 MHz, in this order.
void check_fits_packets(const SensorModel& sensor);

/// What a Kinect v2 with this sensor and these P0 tables measures of a simulated frame.
///
/// Light comes from beside the lens, kinect2::light_source_x_m: each phase is that of half of the
/// light's path to the true range and back. Where the true range is unknown, it is taken to be
/// kinect2::reference_range_m for this purpose. Images are then mirrored, as the camera sends them.
/// Amplitudes are multiplied by packet_units_per_amplitude, and those at the end of the simulator's
/// scale, 65535, are saturated. Kinect2Source is the inverse, up to rounding.
kinect2::Measurements kinect2_measurements(const SimulatedFrame& simulated,
                                           const SensorModel& sensor, const kinect2::P0Tables& p0);

/// Writes all frames as a recording directory of a Kinect v2 (kinect2/recording_writer.hpp) into a
/// new or empty folder, and the truth beside it: groundtruth.txt, range_truth/NNNNNN.png with the
/// numbers of packets, and scene.ply, as in a sequence. The truth is that of Kinect2Source's
/// frames: its images are not mirrored, and its timestamps are those of the camera's clock, of
/// 0.125 ms.
///
/// The P0 tables are synthetic_p0_tables(errors_seed). `keep_going(done, total)` is called before
/// each frame. If it returns false, or if the simulator is stopped, the frames so far remain as an
/// interrupted recording, which is imported with a warning. Returns the number of frames written.
/// Throws UsageError as check_fits_packets() does, and InputError if a file cannot be written.
int simulate_kinect2(const Simulator& simulator, int errors_seed,
                     const std::filesystem::path& folder,
                     const std::function<bool(int done, int total)>& keep_going = {});

}  // namespace tofmap
