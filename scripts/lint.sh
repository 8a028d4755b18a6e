#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 the tofmap authors
# SPDX-License-Identifier: BSD-3-Clause
#
# Checks the format of all files with clang-format, and sources with clang-tidy:
#   scripts/lint.sh [--since COMMIT]   those that changed since a commit (default: the last one),
#   scripts/lint.sh --sample N         N sources, first those that the last commit changed, then
#                                      any, another choice for each commit,
#   scripts/lint.sh --all              all sources, more than an hour of processor time,
#   scripts/lint.sh --format           none: the format alone (CI does this).
# BUILD_DIR is a folder of its own (default: build-lint): elsewhere, files may be compiled together
# or with precompiled headers, which clang-tidy does not know. Headers are checked with the sources
# of their module.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
build=${BUILD_DIR:-build-lint}

since=HEAD~1
most=0
case "${1:-}" in
  "") ;;
  --all) since= ;;
  --format) since=none ;;
  --since) since=${2:?} ;;
  --sample) most=${2:?} ;;
  *)
    echo "usage: scripts/lint.sh [--since COMMIT | --sample N | --all | --format]" >&2
    exit 2
    ;;
esac

git ls-files '*.cpp' '*.hpp' | xargs clang-format-14 --dry-run --Werror
echo "clang-format: all files are formatted"
[[ $since != none ]] || exit 0

tracked() { git ls-files 'modules/*.cpp' 'apps/*.cpp' 'benchmarks/*.cpp'; }

# The sources that changed, and those of the module whose headers changed.
changed() {
  git diff --name-only --diff-filter=d "$since" -- {modules,apps,benchmarks}/'*.[ch]pp' |
    while read -r file; do
      case $file in
        *.cpp) echo "$file" ;;
        modules/*.hpp) git ls-files "$(cut -d/ -f1-2 <<<"$file")/*.cpp" ;;
        *.hpp) git ls-files "$(dirname "$file")/*.cpp" ;;
      esac
    done | sort -u
}

if [[ -z $since ]]; then
  mapfile -t sources < <(tracked)
elif git rev-parse -q --verify "$since^{commit}" >/dev/null; then
  mapfile -t sources < <(changed)
elif [[ $since == HEAD~1 ]]; then  # a clone of the last commit alone: all files count as changed
  mapfile -t sources < <(tracked)
else
  echo "scripts/lint.sh: there is no commit '$since'" >&2
  exit 2
fi
if ((most > 0)); then
  mapfile -t sources < <({ printf '%s\n' "${sources[@]}"; echo; tracked; } | python3 -c '
import random, sys
commit, most = sys.argv[1], int(sys.argv[2])
changed, tracked = (part.split() for part in sys.stdin.read().split("\n\n"))
others = [source for source in tracked if source not in changed]
choice = random.Random(commit)
choice.shuffle(changed)
choice.shuffle(others)
print("\n".join((changed + others)[:most]))
' "$(git rev-parse HEAD)" "$most")
fi
if ((${#sources[@]} == 0)); then
  echo "clang-tidy: no source has changed since $since"
  exit
fi
cmake -S . -B "$build" -G Ninja -DCMAKE_BUILD_TYPE=Release -DTOFMAP_BUILD_TESTS=OFF \
  -DTOFMAP_BUILD_BENCHMARKS=ON -DTOFMAP_PRECOMPILE_HEADERS=OFF -DCMAKE_UNITY_BUILD=OFF >/dev/null
printf '%s\n' "${sources[@]}" |
  xargs -P "$(nproc)" -n 1 clang-tidy-14 -p "$build" --quiet
echo "clang-tidy: ${#sources[@]} files have no findings"
