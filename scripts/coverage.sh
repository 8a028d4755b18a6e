#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 the tofmap authors
# SPDX-License-Identifier: BSD-3-Clause
#
# Installs missing packages, builds the libraries and their tests with line coverage, runs the
# tests, and prints the line coverage of modules/. Lines that only the program runs do not count.
# BUILD_DIR is the build folder (default: build-coverage).
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
bash scripts/packages.sh --tests
build=${BUILD_DIR:-build-coverage}

cmake -S . -B "$build" -G Ninja -DCMAKE_BUILD_TYPE=Debug -DCMAKE_CXX_FLAGS_DEBUG="-O1 -g1" \
  -DTOFMAP_COVERAGE=ON -DTOFMAP_BUILD_PROGRAM=OFF -DTOFMAP_PRECOMPILE_HEADERS=ON
cmake --build "$build"
find "$build" -name '*.gcda' -delete
ctest --test-dir "$build" --output-on-failure -j "$(nproc)"
gcovr --root . --filter modules/ --exclude-throw-branches --sort-percentage "$build"
