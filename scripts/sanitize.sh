#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 the tofmap authors
# SPDX-License-Identifier: BSD-3-Clause
#
# Installs missing packages, builds tofmap with Clang, warnings as errors and sanitizers, and runs
# tests under them:
#   scripts/sanitize.sh          address and undefined behaviour, all tests;
#   scripts/sanitize.sh input    address and undefined behaviour, the tests of the modules that read
#                                and unwrap frames, and those of damaged input for the program;
#   scripts/sanitize.sh thread   threads, the tests of the modules that have threads of their own.
# Further arguments go to ctest, for instance -E NAMES, which leaves tests out.
# The thread sanitizer does not see OpenMP's synchronisation and would report false races, so OpenMP
# runs with one thread. The presets of CMakePresets.json have the flags. Leak detection is off: VTK
# and its drivers keep memory until the end of the process.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
configure=sanitize
build=sanitize
tests=(sanitize)
case "${1:-}" in
  "" | -*) ;;
  input)
    build=sanitize-input
    tests=(sanitize-input sanitize-damage)
    shift
    ;;
  thread)
    configure=sanitize-thread
    build=sanitize-thread
    tests=(sanitize-thread)
    shift
    ;;
  *)
    echo "usage: scripts/sanitize.sh [input|thread] [ARGUMENTS OF CTEST]" >&2
    exit 2
    ;;
esac
bash scripts/packages.sh --tests
export OMP_WAIT_POLICY=passive  # several tests run at once: threads that wait must not spin
cmake --preset "$configure"
cmake --build --preset "$build"
for preset in "${tests[@]}"; do
  ctest --preset "$preset" -j "$(nproc)" "$@"
done
