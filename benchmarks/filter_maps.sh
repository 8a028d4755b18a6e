#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 the tofmap authors
# SPDX-License-Identifier: BSD-3-Clause
#
# Measures the effect of each filter on the map: prints a Markdown table of trajectory error, map
# error and completeness, with filters removed from the default chain or added to it. Recordings are
# simulated; more can be given as arguments. BUILD_DIR is the build folder (default: build).
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
source benchmarks/scene_tables.sh

for scene in room corridor hall; do simulate "$scene" "$scene"; done
recordings+=("$@")

figure() {  # NAME: prints this figure of the last report, or a dash if it has none
  local value
  value=$(sed -n "s/.*\"$1\": \([0-9.e-]*\).*/\1/p" "$work/result/report.json")
  printf '%s' "${value:-–}"
}

scaled() {  # FACTOR DIGITS NAME: prints a figure times FACTOR
  local value
  value=$(figure "$3")
  [[ $value == – ]] && printf '–' || awk "BEGIN { printf \"%.$2f\", $1 * $value }"
}

line() {  # LABEL CHAIN [SETTING…]: prints a line of the table
  local label=$1 settings=(--set "filters.chain=$2")
  shift 2
  for setting in "$@"; do settings+=(--set "$setting"); done
  printf '| %s |' "$label"
  for recording in "${recordings[@]}"; do
    "$tofmap" evaluate "$recording" --out "$work/result" --quiet >/dev/null \
      --set evaluation.methods=joint --set pictures.frames=0 "${settings[@]}"
    printf ' %s / %s / %s (%s) |' "$(scaled 1000 1 ate_rmse_m)" "$(scaled 1000 1 accuracy_m)" \
      "$(scaled 1 1 completeness_percent)" "$(figure registered_frames)"
  done
  printf '\n'
}

table_head "trajectory, mm / map, mm / seen, % (frames registered)"
line "no filter" ""
line "the default: isolated_wrap plane_edge" "isolated_wrap plane_edge"
line "without isolated_wrap" "plane_edge"
line "without plane_edge" "isolated_wrap"
line "jump_edge instead" "isolated_wrap jump_edge"
line "jump_edge as published instead" "isolated_wrap jump_edge" filters.min_edge_gap_sigmas=0
line "step_edge instead" "isolated_wrap step_edge"
line "outlier instead" "isolated_wrap outlier"
line "with outlier, too" "isolated_wrap plane_edge outlier"
line "with smooth, too" "isolated_wrap plane_edge smooth"
line "with confidence ≥ 0.9, too" "isolated_wrap confidence plane_edge" filters.min_confidence=0.9
