#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 the tofmap authors
# SPDX-License-Identifier: BSD-3-Clause
#
# Measures the effect of each parameter of the method `jump`: prints a Markdown table of wrong wraps
# with one parameter changed at a time. Recordings are simulated; more can be given as arguments.
# BUILD_DIR is the build folder (default: build).
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
source benchmarks/scene_tables.sh

for scene in slope beyond corridor flat; do simulate "$scene" "$scene" --frames 10; done
simulate room room --frames 30
simulate room room_5cm --frames 30 --set simulator.range_noise_m=0.05
recordings+=("$@")

figure() {  # NAME: prints this figure of the last report
  sed -n "s/.*\"$1\": \([0-9.e-]*\).*/\1/p" "$work/result/report.json"
}

line() {  # LABEL [SETTING…]: prints a line of the table
  local label=$1 settings=()
  shift
  for setting in "$@"; do settings+=(--set "$setting"); done
  printf '| %s |' "$label"
  for recording in "${recordings[@]}"; do
    "$tofmap" evaluate "$recording" --out "$work/result" --quiet >/dev/null \
      --set evaluation.methods=jump --set evaluation.down_to=unwrapping "${settings[@]}"
    printf ' %.2f (%.0f) |' "$(figure wrong_wrap_percent)" "$(figure converged_percent)"
  done
  printf '\n'
}

table_head "wrong wraps, % (frames that converge, %)"
line "as it is"
for value in 1 3 9; do line "k = $value" "unwrap.window_px=$value"; done
for value in 0.03 0.14 0.28; do line "σ = $value" "unwrap.sigma_cycles=$value"; done
for value in 0.5 0.99; do line "c_d = $value" "unwrap.trust_discontinuity=$value"; done
for value in 0 0.25 0.75 1; do line "c_f = $value" "unwrap.trust_frequency=$value"; done
for value in 1 3 30; do line "iterations ≤ $value" "unwrap.iterations=$value"; done
for value in 0.3 3; do line "objection share $value" "unwrap.objection_share=$value"; done
line "no objection" "unwrap.objection_share=1000000"
