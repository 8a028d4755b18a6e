# SPDX-FileCopyrightText: 2026 the tofmap authors
# SPDX-License-Identifier: BSD-3-Clause
#
# To be sourced: tables in Markdown with a column for each recording. Recordings are simulated into
# a temporary folder; BUILD_DIR names the build folder (default: build).
tofmap=${BUILD_DIR:-build}/apps/tofmap
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
recordings=()

simulate() {  # SCENE NAME [OPTION…]: adds a recording
  "$tofmap" simulate "$1" --out "$work/$2" --quiet "${@:3}"
  recordings+=("$work/$2")
}

table_head() {  # LABEL
  printf '| %s |' "$1"
  for recording in "${recordings[@]}"; do printf ' %s |' "$(basename "$recording")"; done
  printf '\n|---|'
  for _ in "${recordings[@]}"; do printf -- '---|'; done
  printf '\n'
}
