# SPDX-FileCopyrightText: 2026 the tofmap authors
# SPDX-License-Identifier: BSD-3-Clause
# Functions for scripts that source this: Markdown tables with a column per recording, and
# recordings simulated into a temporary folder. BUILD_DIR is the build folder (default: build).
tofmap=${BUILD_DIR:-build}/apps/tofmap
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
recordings=()

simulate() {  # SCENE NAME [OPTION…]: simulates a recording and adds it to recordings
  "$tofmap" simulate "$1" --out "$work/$2" --quiet "${@:3}"
  recordings+=("$work/$2")
}

table_head() {  # LABEL: prints the head of the table
  printf '| %s |' "$1"
  for recording in "${recordings[@]}"; do printf ' %s |' "$(basename "$recording")"; done
  printf '\n|---|'
  for _ in "${recordings[@]}"; do printf -- '---|'; done
  printf '\n'
}
