#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 the tofmap authors
# SPDX-License-Identifier: BSD-3-Clause
"""Compares docs/architecture.md with the build: which module links which, and what includes what.

Usage: architecture_test.py SOURCE_DIR BUILD_DIR. CMake writes BUILD_DIR/module_links.txt.
"""
import pathlib
import re
import sys
import unittest

SOURCE = pathlib.Path(sys.argv[1]).resolve()
BUILD = pathlib.Path(sys.argv[2]).resolve()

# Folders of modules/unwrap, and those that each may include.
UNWRAP_FOLDERS = {
    "common": {"common"},
    "errors": {"common", "errors"},
    "jump": {"common", "errors", "jump"},
    "joint": {"common", "errors", "joint"},
}


def drawn_edges():
    text = (SOURCE / "docs/architecture.md").read_text(encoding="utf-8")
    drawing = re.search(r"```mermaid\n(.*?)```", text, re.DOTALL).group(1)
    return set(re.findall(r"(\w+) --> (\w+)", drawing))


def built_edges():
    edges = set()
    for line in (BUILD / "module_links.txt").read_text(encoding="utf-8").splitlines():
        module, *links = line.split()
        edges.update((module, link.removeprefix("tofmap::")) for link in links if link.startswith("tofmap::"))
    return edges


class Architecture(unittest.TestCase):
    def test_drawing_shows_the_links_of_the_build(self):
        self.assertEqual(sorted(drawn_edges()), sorted(built_edges()))

    def test_folders_of_unwrap_include_none_above_them(self):
        count = 0
        for root in ("modules/unwrap/src", "modules/unwrap/include/tofmap/unwrap"):
            for file in (SOURCE / root).glob("*/*.?pp"):
                folder = file.parent.name
                for included in re.findall(r'#include ["<](?:tofmap/unwrap/)?(\w+)/\w+\.hpp[">]',
                                           file.read_text(encoding="utf-8")):
                    if included not in UNWRAP_FOLDERS:
                        continue
                    count += 1
                    with self.subTest(file=str(file.relative_to(SOURCE)), includes=included):
                        self.assertIn(included, UNWRAP_FOLDERS[folder])
        self.assertGreater(count, 50, "the pattern finds too few includes")

    def test_nothing_below_includes_the_whole_of_unwrap(self):
        for file in (SOURCE / "modules/unwrap").glob("**/*/*.?pp"):
            if file.name in ("unwrap.hpp", "unwrap.cpp"):
                continue
            with self.subTest(file=str(file.relative_to(SOURCE))):
                self.assertNotIn("tofmap/unwrap/unwrap.hpp", file.read_text(encoding="utf-8"))


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1], verbosity=2)
