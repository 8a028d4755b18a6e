#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 the tofmap authors
# SPDX-License-Identifier: BSD-3-Clause
"""Sources use no algorithm of std::ranges that returns a subrange.

Clang 14, with which the sanitizers are built, does not compile std::ranges::subrange of GCC 12's
library. The algorithms of std with two iterators do the same.
"""
import pathlib
import re
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
SUBRANGES = re.compile(r"std::ranges::(rotate|unique|remove|remove_if|partition|stable_partition|"
                       r"search|search_n|find_end|equal_range)\b")


def main():
    assert SUBRANGES.search("std::ranges::rotate(all, all.begin() + 1);")
    assert not SUBRANGES.search("std::rotate(a, b, c); std::ranges::remove_copy(a, b, 1);")
    listed = subprocess.run(["git", "-C", ROOT, "ls-files", "*.cpp", "*.hpp"], capture_output=True,
                            text=True, check=False)
    paths = [ROOT / name for name in listed.stdout.split()] or list(ROOT.rglob("*.[ch]pp"))
    assert len(paths) > 500
    found = [f"{path.relative_to(ROOT)}:{number}: {line.strip()}" for path in paths
             for number, line in enumerate(path.read_text(encoding="utf-8").splitlines(), 1)
             if SUBRANGES.search(line)]
    if found:
        sys.exit("\n".join(found))


if __name__ == "__main__":
    main()
