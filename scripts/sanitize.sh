#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 the tofmap authors
# SPDX-License-Identifier: BSD-3-Clause
#
# Installs missing packages, builds tofmap with Clang, warnings as errors and sanitizers, and runs
# tests under them:
#   scripts/sanitize.sh          address and undefined behaviour, all tests;
#   scripts/sanitize.sh thread   threads, the tests of the modules that have threads of their own.
# Further arguments go to ctest, for instance -E NAMES, which leaves tests out.
# The thread sanitizer does not see OpenMP's synchronisation and would report false races, so OpenMP
# runs with one thread. The presets of CMakePresets.json have the flags. Leak detection is off: VTK
# and its drivers keep memory until the end of the process.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
case "${1:-}" in
  "" | -*) preset=sanitize ;;
  thread)
    preset=sanitize-thread
    shift
    ;;
  *)
    echo "usage: scripts/sanitize.sh [thread] [ARGUMENTS OF CTEST]" >&2
    exit 2
    ;;
esac
bash scripts/packages.sh --tests
cmake --preset "$preset"
cmake --build --preset "$preset"
ctest --preset "$preset" -j "$(nproc)" "$@"
