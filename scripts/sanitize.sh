#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 the tofmap authors
# SPDX-License-Identifier: BSD-3-Clause
#
# Installs missing packages, builds tofmap with the address and undefined-behaviour sanitizers, and
# runs all tests. BUILD_DIR is the build folder (default: build-sanitize).
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
bash scripts/packages.sh --tests
build=${BUILD_DIR:-build-sanitize}

cmake -S . -B "$build" -G Ninja -DCMAKE_BUILD_TYPE=Debug -DCMAKE_CXX_FLAGS_DEBUG="-O1 -g1" \
  -DTOFMAP_SANITIZE=address,undefined -DTOFMAP_PRECOMPILE_HEADERS=ON
cmake --build "$build"
# Leak detection is off: VTK and its drivers keep memory until the end of the process.
ASAN_OPTIONS=detect_leaks=0 ctest --test-dir "$build" --output-on-failure -j "$(nproc)"
