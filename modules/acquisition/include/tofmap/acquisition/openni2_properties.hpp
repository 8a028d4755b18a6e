// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// What tofmap's OpenNI2 devices answer beyond OpenNI2's own properties (docs/cameras.md). The
/// playback speed is OpenNI2's own property, DEVICE_PROPERTY_PLAYBACK_SPEED (float): 1 is the speed
/// of the recording, 0 as fast as frames can be made, -1 one frame whenever a client waits for one.
namespace tofmap::openni2_property {

/// What messages of the driver begin with where a URI asks for what is not allowed.
inline constexpr const char* usage_error = "tofmap, wrong use: ";

inline constexpr int vendor = 0x746f0000;

inline constexpr int frequency_a_hz = vendor + 1;    ///< of the device, double, read only
inline constexpr int frequency_b_hz = vendor + 2;    ///< of the device, double, read only
inline constexpr int layout = vendor + 3;            ///< of the device, text, read only
inline constexpr int frames_delivered = vendor + 4;  ///< of the device, int, read only

/// Of the device, int, write only: that a client has read so many images more. At the speed -1 a
/// device that is told makes no image before the last one was read on all its running streams, for
/// up to a second after which OpenNI2 must have dropped it; one that is not told gives 10 ms.
inline constexpr int images_read = vendor + 5;

/// A command of the device, without data: it goes as if its plug had been pulled.
inline constexpr int unplug = vendor + 16;

}  // namespace tofmap::openni2_property
