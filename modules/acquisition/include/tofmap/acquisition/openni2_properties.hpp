// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Properties and commands of tofmap's OpenNI2 devices that OpenNI2 itself does not define
/// (docs/cameras.md). The playback speed is a property of OpenNI2, DEVICE_PROPERTY_PLAYBACK_SPEED
/// (float): 1 plays at the speed of the recording, 0 as fast as possible, and -1 delivers one frame
/// whenever a client waits for one.
namespace tofmap::openni2_property {

/// Prefix of the driver's messages about a URI that is not allowed.
inline constexpr const char* usage_error = "tofmap, wrong use: ";

/// Base of the numbers below.
inline constexpr int vendor = 0x746f0000;

inline constexpr int frequency_a_hz = vendor + 1;    ///< device property, double, read only
inline constexpr int frequency_b_hz = vendor + 2;    ///< the same, if there are two or more
inline constexpr int layout = vendor + 3;            ///< device property, text, read only
inline constexpr int frames_delivered = vendor + 4;  ///< device property, int, read only

/// Device property, int, write only: the number of images that the client has read since it last
/// set this property. At speed -1, a device whose client sets it makes no image until the previous
/// one was read on all running streams, but waits at most one second, after which OpenNI2 must have
/// dropped the image. A device whose client never sets it waits 10 ms.
inline constexpr int images_read = vendor + 5;

/// Device property, one to eight values of type double, read only: all modulation frequencies in
/// the order of the images. A client whose buffer is too small gets ONI_STATUS_BAD_PARAMETER.
inline constexpr int frequencies_hz = vendor + 6;

/// Device command, without data: the device disappears as if it had been unplugged.
inline constexpr int unplug = vendor + 16;

}  // namespace tofmap::openni2_property
