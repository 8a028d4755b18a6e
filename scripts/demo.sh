#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 the tofmap authors
# SPDX-License-Identifier: BSD-3-Clause
#
# Installs missing packages, builds tofmap, simulates a recording of a furnished room of 12 x 9 m,
# and maps it with and without unwrapping. BUILD_DIR is the build folder (default: build), OUT_DIR
# the folder of the results (default: out/demo).
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
bash scripts/packages.sh
build=${BUILD_DIR:-build}
out=${OUT_DIR:-out/demo}

cmake -S . -B "$build" -G Ninja -DCMAKE_BUILD_TYPE=Release -DTOFMAP_BUILD_TESTS=OFF \
  -DTOFMAP_PRECOMPILE_HEADERS=ON -DCMAKE_UNITY_BUILD=ON \
  -DCMAKE_CXX_COMPILER_LAUNCHER=ccache >/dev/null
cmake --build "$build" --target tofmap
tofmap="$build/apps/tofmap"

"$tofmap" simulate room --out "$out/recording"
"$tofmap" info "$out/recording"
"$tofmap" map "$out/recording" --out "$out/map"
"$tofmap" map "$out/recording" --out "$out/map_wrapped" --method none
"$tofmap" evaluate "$out/recording" --out "$out/evaluation"

echo
echo "with and without unwrapping: $out/evaluation/report.html, open it in a browser"
echo "the map:                     $out/map/map.ply, view it with: $tofmap view $out/map"
echo "its report and pictures:     $out/map/report.html, $out/map/pictures"
echo "the map without unwrapping:  $out/map_wrapped/map.ply"
echo "the recording:               $out/recording"
