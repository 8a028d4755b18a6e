#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 the tofmap authors
# SPDX-License-Identifier: BSD-3-Clause
#
# Prints a Markdown table of the trajectory error of the project's registration and of PCL's ICP and
# GICP, against keyframes and frame to frame, with and without unwrapping. Recordings are simulated;
# more, with ground truth, can be given as arguments. BUILD_DIR is the build folder (default:
# build).
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
source benchmarks/scene_tables.sh

for scene in room hall; do simulate "$scene" "$scene"; done
recordings+=("$@")

# Makes every frame a keyframe, and registers each frame only with the one before it.
chain=(odometry.keyframes_around=1 odometry.keyframe_translation_m=0.01 odometry.keyframe_rotation_rad=0.01
       loops.close=false)

errors() {  # SEQ [SETTING…]: prints the errors with and without unwrapping, metres
  local sequence=$1 settings=()
  shift
  for setting in "$@"; do settings+=(--set "$setting"); done
  "$tofmap" evaluate "$sequence" --out "$work/result" --quiet --set evaluation.methods="joint none" \
    --set pictures.frames=0 "${settings[@]}" >&2
  python3 - "$work/result/report.json" <<'PYTHON'
import json
import sys

with open(sys.argv[1], encoding="utf-8") as file:
    trajectory = json.load(file)["trajectory"]
cells = []
for method in ("joint", "none"):
    error = trajectory.get(method, {}).get("ate_rmse_m")
    cells.append("lost" if error is None else f"{error:.4f}" if error < 0.1 else f"{error:.2f}")
print(" / ".join(cells), end="")
PYTHON
}

line() {  # LABEL [SETTING…]: prints a line of the table
  printf '| %s |' "$1"
  shift
  for recording in "${recordings[@]}"; do printf ' %s |' "$(errors "$recording" "$@")"; done
  printf '\n'
}

table_head "ATE, m, unwrapped / wrapped"
line "ours, loops closed"
line "ours, loops open" loops.close=false
line "ours, frame to frame" "${chain[@]}"
line "PCL's GICP against keyframes" registration.method=pcl_gicp loops.close=false
line "PCL's GICP frame to frame" registration.method=pcl_gicp "${chain[@]}"
line "PCL's ICP against keyframes" registration.method=pcl_icp loops.close=false
line "PCL's ICP frame to frame" registration.method=pcl_icp "${chain[@]}"
