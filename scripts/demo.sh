#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 the tofmap authors
# SPDX-License-Identifier: BSD-3-Clause
#
# Installs what is missing, builds tofmap, simulates a recording of a furnished room of 12 x 9 m,
# and maps it with and without unwrapping. BUILD_DIR and OUT_DIR choose the folders (default:
# build and out/demo).
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
bash scripts/packages.sh
build=${BUILD_DIR:-build}
out=${OUT_DIR:-out/demo}

cmake -S . -B "$build" -G Ninja -DCMAKE_BUILD_TYPE=Release -DCMAKE_CXX_COMPILER_LAUNCHER=ccache \
  >/dev/null
cmake --build "$build" --target tofmap
tofmap="$build/apps/tofmap"

"$tofmap" simulate room --out "$out/recording"
"$tofmap" info "$out/recording"
"$tofmap" map "$out/recording" --out "$out/map"
"$tofmap" map "$out/recording" --out "$out/map_wrapped" --method none
"$tofmap" evaluate "$out/recording" --out "$out/evaluation"

echo
echo "recording:                 $out/recording"
echo "map with unwrapping:       $out/map/map.ply, look at it with: $tofmap view $out/map"
echo "map without (for compare): $out/map_wrapped/map.ply"
echo "pictures of both maps:     $out/map/pictures, $out/map_wrapped/pictures"
echo "figures of all methods:    $out/evaluation/report.json, maps in $out/evaluation/pictures"
