#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 the tofmap authors
# SPDX-License-Identifier: BSD-3-Clause
#
# Installs what is missing, builds tofmap under the address and undefined-behaviour sanitizers, runs
# all tests, and prints the line coverage of modules/. BUILD_DIR chooses the build folder (default:
# build-sanitize).
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
bash scripts/packages.sh
build=${BUILD_DIR:-build-sanitize}

cmake -S . -B "$build" -G Ninja -DCMAKE_BUILD_TYPE=Debug -DCMAKE_CXX_FLAGS_DEBUG="-O2 -g1" \
  -DTOFMAP_WARNINGS_AS_ERRORS=ON -DTOFMAP_SANITIZE=address,undefined -DTOFMAP_COVERAGE=ON \
  -DCMAKE_CXX_COMPILER_LAUNCHER=ccache
cmake --build "$build"
find "$build" -name '*.gcda' -delete
# Libraries of others keep memory until the end of the process; that is not what is looked for.
ASAN_OPTIONS=detect_leaks=0 ctest --test-dir "$build" --output-on-failure -j "$(nproc)"
gcovr --root . --filter modules/ --exclude-throw-branches --sort-percentage "$build"
