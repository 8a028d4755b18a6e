#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 the tofmap authors
# SPDX-License-Identifier: BSD-3-Clause
"""Follows every link between documents, and looks for every file of the project that they name.

Usage: documented_files_test.py SOURCE_DIR.
"""
import pathlib
import re
import sys
import unittest

SOURCE = pathlib.Path(sys.argv[1]).resolve()
FOLDERS = "apps|benchmarks|cmake|configs|datasets|docs|examples|modules|scripts|tests"


def documents():
    return [file for pattern in ("*.md", "docs/**/*.md", "configs/**/*.md", "datasets/*/*.md", "examples/*.md")
            for file in sorted(SOURCE.glob(pattern))]


def anchors(document):
    """Those that headings get."""
    for heading in re.findall(r"^#+ (.*)$", document.read_text(encoding="utf-8"), re.MULTILINE):
        yield re.sub(r"[^\w\- ]", "", heading.lower()).replace(" ", "-")


class DocumentedFiles(unittest.TestCase):
    def expect_each(self, pattern, holds):
        """What the pattern finds in documents, and whether holds(document, found)."""
        count = 0
        for document in documents():
            for found in re.findall(pattern, document.read_text(encoding="utf-8")):
                count += 1
                with self.subTest(document=str(document.relative_to(SOURCE)), names=found):
                    self.assertTrue(holds(document, found))
        self.assertGreater(count, 0, "the pattern finds nothing")

    def test_links_lead_to_files_and_headings(self):
        def leads_somewhere(document, link):
            name, _, anchor = link.partition("#")
            target = document.parent / name if name else document
            return target.exists() and (not anchor or anchor in anchors(target))
        self.expect_each(r"\]\((?!http)([^)\s]+)\)", leads_somewhere)

    def test_files_that_are_named_exist(self):
        self.expect_each(rf"(?<![\w/.-])((?:{FOLDERS})/[\w/.-]+\.\w+)",
                         lambda _, name: "NAME" in name or (SOURCE / name).exists())

    def test_benchmarks_that_are_named_are_built(self):
        targets = (SOURCE / "benchmarks/CMakeLists.txt").read_text(encoding="utf-8")
        self.expect_each(r"benchmarks/(bench_\w+)", lambda _, name: f"add_executable({name} " in targets)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1], verbosity=2)
