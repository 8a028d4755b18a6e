#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 the tofmap authors
# SPDX-License-Identifier: BSD-3-Clause
"""Pages have lines of at most 100 columns, but for tables, code and links that cannot be broken."""

import pathlib
import re
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
PAGES = [ROOT / name for name in ("README.md", "CONTRIBUTING.md", "CHANGELOG.md")]
GENERATED = ROOT / "docs" / "options.md"
MOST_COLUMNS = 100


def long_lines(text):
    in_code = False
    for number, line in enumerate(text.split("\n"), 1):
        if line.lstrip().startswith("```"):
            in_code = not in_code
        is_table = line.lstrip().startswith("|")
        is_one_word = re.fullmatch(r"[\s>*-]*\S+", line) is not None
        if len(line) > MOST_COLUMNS and not (in_code or is_table or is_one_word):
            yield number


def main():
    assert list(long_lines("a " * 60)) == [1]
    assert not list(long_lines("| " + "a " * 60))
    pages = PAGES + [page for page in sorted(ROOT.glob("docs/*.md")) if page != GENERATED]
    found = [f"{page.relative_to(ROOT)}:{line}" for page in pages
             for line in long_lines(page.read_text())]
    if found:
        sys.exit(f"lines of more than {MOST_COLUMNS} columns: {', '.join(found)}")


if __name__ == "__main__":
    main()
