#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 the tofmap authors
# SPDX-License-Identifier: BSD-3-Clause
#
# Installs what is missing, builds tofmap under the address and undefined-behaviour sanitizers and
# with line coverage, runs all tests, and prints the lines of modules/ that they reach. BUILD_DIR
# chooses the build folder (default: build-check).
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
bash scripts/packages.sh
build=${BUILD_DIR:-build-check}

cmake -S . -B "$build" -G Ninja -DCMAKE_BUILD_TYPE=Debug -DCMAKE_CXX_FLAGS_DEBUG="-O1 -g1" \
  -DTOFMAP_SANITIZE=address,undefined -DTOFMAP_COVERAGE=ON -DTOFMAP_PRECOMPILE_HEADERS=ON
cmake --build "$build"
find "$build" -name '*.gcda' -delete
# VTK and the drivers it draws with keep memory until the end of the process.
ASAN_OPTIONS=detect_leaks=0 ctest --test-dir "$build" --output-on-failure -j "$(nproc)"
gcovr --root . --filter modules/ --exclude-throw-branches --sort-percentage "$build"
