#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 the tofmap authors
# SPDX-License-Identifier: BSD-3-Clause
#
# Installs the Debian packages of a folder on this very system, as a user would, tries them, builds an
# example against them, and removes them again. Root's, for CI and for fresh systems, such as
# `mmdebstrap --variant=minbase bookworm ROOT` makes:
#   installed_packages.sh PACKAGES EXAMPLES
set -euo pipefail
packages=$(realpath "$1")
examples=$(realpath "$2")
export DEBIAN_FRONTEND=noninteractive
scratch=$(mktemp --directory)
names=()
for package in "$packages"/*.deb; do
  names+=("$(dpkg-deb --field "$package" Package)")
done

for name in "${names[@]}"; do
  if dpkg-query --show --showformat='${Status}' "$name" 2>/dev/null | grep -q 'ok installed'; then
    echo "packages: $name is installed already; remove it first, this would do so" >&2
    exit 1
  fi
done

clean_up() {
  cd /
  rm -rf "$scratch"
  apt-get purge -y -qq "${names[@]}" >/dev/null || true
}
trap clean_up EXIT
cd "$scratch"
say() { echo "packages: $*"; }

say "installing the program"
apt-get update -qq
apt-get install -y -qq --no-install-recommends "$packages"/libtofmap[0-9]*.deb "$packages"/tofmap_*.deb >/dev/null
tofmap --version

say "recording from the driver among OpenNI2's own, mapping, drawing without a display"
tofmap record "tofmap://room?speed=-1&simulator.width_px=88&simulator.height_px=72" --frames 12 --out recording --quiet
tofmap map recording --out map --config /usr/share/tofmap/configs/pipelines/trusted_pixels.yaml --quiet
test -s map/map.ply
test -s map/report.html
tofmap view map --screenshot map.png --quiet
test -s map.png

say "building the example that links tofmap::unwrap alone"
apt-get install -y -qq --no-install-recommends cmake g++ make "$packages"/*.deb >/dev/null
cmake -S "$examples/unwrap_wall" -B build >/dev/null
cmake --build build
build/unwrap_wall
say "installed, tried and removed: ${names[*]}"
