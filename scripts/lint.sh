#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 the tofmap authors
# SPDX-License-Identifier: BSD-3-Clause
#
# Checks the format of all files with clang-format, and with clang-tidy
#   scripts/lint.sh --since COMMIT   what changed since a commit (default: HEAD~1, the last commit),
#   scripts/lint.sh --all            everything: about an hour of processor time.
# BUILD_DIR is a configured build folder, whose compile_commands.json is used (default: build).
# Headers are checked with the sources that include them.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
build=${BUILD_DIR:-build}

since=HEAD~1
case "${1:---since}" in
  --all) since= ;;
  --since) since=${2:-$since} ;;
  *)
    echo "usage: scripts/lint.sh [--since COMMIT | --all]" >&2
    exit 2
    ;;
esac

git ls-files '*.cpp' '*.hpp' | xargs clang-format-14 --dry-run --Werror
echo "clang-format: all files are formatted"

if [[ -z $since ]]; then
  mapfile -t sources < <(git ls-files 'modules/*.cpp' 'apps/*.cpp' 'benchmarks/*.cpp')
else
  mapfile -t sources < <(git diff --name-only --diff-filter=d "$since" -- \
    'modules/*.cpp' 'apps/*.cpp' 'benchmarks/*.cpp')
fi
if ((${#sources[@]} == 0)); then
  echo "clang-tidy: no source has changed since $since"
  exit
fi
# Precompiled headers are GCC's.
database=$(mktemp -d)
trap 'rm -rf "$database"' EXIT
sed -E 's/-Winvalid-pch -include [^ ]+cmake_pch.hxx//' "$build/compile_commands.json" \
  >"$database/compile_commands.json"
printf '%s\n' "${sources[@]}" |
  xargs -P "$(nproc)" -n 1 clang-tidy-14 -p "$database" --quiet
echo "clang-tidy: ${#sources[@]} files have no findings"
