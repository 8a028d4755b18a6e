// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Reads frames from an OpenNI2 device for a long time, and prints frame rate, losses and memory:
//
//     bench_device_soak [URI [FRAMES]]

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <fstream>
#include <string>

#include <unistd.h>

#include <tofmap/acquisition/openni2_source.hpp>

namespace {

constexpr const char* default_uri =
    "tofmap://"
    "room?speed=0&repeat=0&simulator.subpixels=1&simulator.width_px=88&simulator.height_px=72";
constexpr int default_frames = 10000;

double memory_mb() {
  long pages = 0;
  long resident = 0;
  std::ifstream("/proc/self/statm") >> pages >> resident;
  return 1e-6 * static_cast<double>(resident) * static_cast<double>(sysconf(_SC_PAGESIZE));
}

void soak(const std::string& uri, int frames) {
  using Clock = std::chrono::steady_clock;
  tofmap::OpenNi2Source source(uri, {});
  const int frames_per_line = std::max(1, frames / 10);
  auto last = Clock::now();
  std::printf("%s\n%8s %10s %12s %12s %10s\n", uri.c_str(), "frames", "per second", "unpaired",
              "lost", "memory MB");
  for (int i = 1; i <= frames; ++i) {
    if (!source.next()) {
      std::printf("the device ended after %d frames\n", i - 1);
      return;
    }
    if (i % frames_per_line != 0) continue;
    const auto now = Clock::now();
    const double rate = frames_per_line / std::chrono::duration<double>(now - last).count();
    last = now;
    const tofmap::PairingCounts counts = source.counts();
    std::printf("%8d %10.1f %12d %12d %10.1f\n", i, rate, counts.dropped(), counts.lost,
                memory_mb());
    std::fflush(stdout);
  }
}

}  // namespace

int main(int argc, char** argv) {
  try {
    soak(argc > 1 ? argv[1] : default_uri, argc > 2 ? std::atoi(argv[2]) : default_frames);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
