#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 the tofmap authors
# SPDX-License-Identifier: BSD-3-Clause
#
# Makes the Debian packages of BUILD_DIR and looks into them, without installing any:
#   packages_test.sh BUILD_DIR VERSION
set -euo pipefail
build=$1
version=$2
packages=$build/packages
root=$build/packages/root

fail() {
  echo "packages: $*" >&2
  exit 1
}
# relations PACKAGE [FIELD]: which packages it depends on, or what else FIELD says of others.
relations() { dpkg-deb --field "$packages/$1"_"$version"_*.deb "${2:-Depends}"; }
# wants PACKAGE OTHER [FIELD]
wants() {
  [[ $(relations "$1" "${3:-Depends}") == *"$2"* ]] || fail "$1 does not name $2: $(relations "$1" "${3:-Depends}")"
}

rm -rf "$packages"
mkdir -p "$root"
(cd "$build" && cpack) >"$build/cpack.log" 2>&1 || fail "cpack failed: $(cat "$build/cpack.log")"
library=$(basename "$packages"/libtofmap[0-9]*.deb)
library=${library%%_*}
for name in "$library" libtofmap-dev tofmap; do
  dpkg-deb --extract "$packages/${name}_${version}"_*.deb "$root/$name"
  [[ -s $root/$name/usr/share/doc/$name/copyright ]] || fail "$name tells no licence"
done
wants "$library" libpcl-common
wants "$library" libyaml-cpp
wants libtofmap-dev "$library (= $version)"
wants libtofmap-dev libeigen3-dev
wants libtofmap-dev libpcl-dev Recommends
wants tofmap "$library (= $version)"
[[ $(relations libtofmap-dev) != *pcl* ]] || fail "tofmap::unwrap alone would bring PCL"

# What users look for, in the package it belongs to, and in no other.
# has PACKAGE PATTERN: a path under /usr
has() {
  [[ -n $(find "$root/$1" -path "$root/$1/usr/$2") ]] || fail "$1 has no $2"
}
has "$library" 'lib/*/libtofmap_unwrap.so.*'
has libtofmap-dev 'lib/*/libtofmap_unwrap.so'
has libtofmap-dev 'lib/*/cmake/tofmap/tofmapConfig.cmake'
has libtofmap-dev include/tofmap/unwrap/unwrap.hpp
has libtofmap-dev share/doc/tofmap/examples/unwrap_wall/unwrap_wall.cpp
has tofmap bin/tofmap
has tofmap 'lib/*/OpenNI2/Drivers/libTofmap.so.0'
has tofmap share/man/man1/tofmap.1
has tofmap share/bash-completion/completions/tofmap
has tofmap share/tofmap/configs/README.md
doubled=$(for name in "$library" libtofmap-dev tofmap; do
  (cd "$root/$name" && find . ! -type d)
done | sort | uniq -d)
[[ -z $doubled ]] || fail "in two packages: $doubled"

# Nothing leads back to where it was built.
leads=$(grep --recursive --files-with-matches --fixed-strings "$build" "$root" || true)
[[ -z $leads ]] || fail "names the build folder: $leads"

mkdir "$root/all"
cp --recursive --no-dereference "$root/$library/." "$root/tofmap/." "$root/all"
[[ $("$root/all/usr/bin/tofmap" --version) == "$version" ]] || fail "the program does not run"
