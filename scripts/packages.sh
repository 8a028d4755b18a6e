#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 the tofmap authors
# SPDX-License-Identifier: BSD-3-Clause
#
# Installs the Debian 12 packages that are needed to build and run tofmap and, with --tests, also
# those of its tests. Packages that are installed already are skipped.
set -euo pipefail

packages=(
  build-essential cmake ninja-build ccache pkg-config git file
  libeigen3-dev libyaml-cpp-dev libpng-dev libembree-dev libpcl-dev libceres-dev libvtk9-dev
  libboost-dev libsqlitecpp-dev libsqlite3-dev zlib1g-dev sqlite3 libopenni2-dev libtiff-dev libzip-dev
  libjs-three libegl-dev libegl1 libgl1-mesa-dri libx11-dev
  nlohmann-json3-dev libcli11-dev libfmt-dev
)
if (($# > 1)) || [[ ${1:---tests} != --tests ]]; then
  echo "usage: scripts/packages.sh [--tests]" >&2
  exit 2
fi
if (($# == 1)); then
  packages+=(
    libgtest-dev libgmock-dev libbenchmark-dev gcovr xvfb
    clang-14 clang-format-14 clang-tidy-14 doxygen
    chromium chromium-driver python3-selenium python3-pil python3-yaml
  )
fi
missing=()
for package in "${packages[@]}"; do
  dpkg-query -W -f='${Status}' "$package" 2>/dev/null | grep -q 'ok installed' || missing+=("$package")
done
if ((${#missing[@]} > 0)); then
  as_root=()
  [[ $(id -u) -eq 0 ]] || as_root=(sudo)
  echo "installing: ${missing[*]}" >&2
  "${as_root[@]}" apt-get update -qq
  DEBIAN_FRONTEND=noninteractive "${as_root[@]}" apt-get install -y -qq --no-install-recommends "${missing[@]}" >/dev/null
fi
