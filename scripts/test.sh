#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 the tofmap authors
# SPDX-License-Identifier: BSD-3-Clause
#
# Installs missing packages, builds tofmap as for its Debian packages, with warnings as errors, and
# runs all tests. BUILD_DIR is the build folder (default: build).
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
bash scripts/packages.sh --tests
build=${BUILD_DIR:-build}

cmake -S . -B "$build" -G Ninja -DCMAKE_BUILD_TYPE=Release \
  -DTOFMAP_BUILD_TESTS=ON -DTOFMAP_WARNINGS_AS_ERRORS=ON -DTOFMAP_DEBIAN_PACKAGES=ON \
  -DTOFMAP_PRECOMPILE_HEADERS=ON -DCMAKE_UNITY_BUILD=ON \
  -DCMAKE_CXX_COMPILER_LAUNCHER=ccache
cmake --build "$build"
# As many tests run at once as there are cores, and each may use all of them: threads that wait must
# not spin.
export OMP_WAIT_POLICY=passive
ctest --test-dir "$build" --output-on-failure -j "$(nproc)"
