#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 the tofmap authors
# SPDX-License-Identifier: BSD-3-Clause
"""Prints a page of the docs as Doxygen reads it: the input filter of docs/Doxyfile.in.

The pages link to headings as code hosts name them (`page.md#a-heading`), which Doxygen 1.9 does not
know. Headings get labels that name their page, links to them use those labels, and links to files
that are no page become the names of these files. A heading that a page repeats is numbered, as code
hosts do.
"""

import collections
import pathlib
import re
import sys

HEADING = re.compile(r"^(#{2,6}) (.*?)[ \t]*$", re.MULTILINE)
LINK = re.compile(r"(!?)\[([^\]]*)\]\(([^)\s]+)\)")
PAGES = ("README.md", "CONTRIBUTING.md", "CHANGELOG.md")


def slug(heading):
    """The name that code hosts give to a heading."""
    text = LINK.sub(r"\2", heading).lower()
    return re.sub(r"[^\w\- ]", "", text).replace(" ", "-")


def label(page, anchor):
    return f"{page.stem.lower()}-{anchor}"


def is_page(path, root):
    return path.suffix == ".md" and (path.parent == root / "docs" or path in
                                     [root / name for name in PAGES])


def converted_link(match, page, root):
    is_image, text, target = match.groups()
    text = " ".join(text.split())  # Doxygen wants the text of a link on one line
    if is_image:
        return f"![{text}]({pathlib.Path(target).name})"
    if re.match(r"[a-z]+:", target):
        return match.group()
    file, _, anchor = target.partition("#")
    path = (page.parent / file).resolve() if file else page
    if not is_page(path, root):
        name = path.relative_to(root) if path.is_relative_to(root) else target
        return f"{text} (`{name}`)"
    if anchor:
        return f"[{text}](@ref {label(path, anchor)})"
    return f"[{text}]({path})"


def labelled_heading(match, page, uses):
    """Counts in `uses` how often the page had this heading."""
    title = LINK.sub(r"\2", match[2])
    anchor = slug(match[2])
    number = f"-{uses[anchor]}" if uses[anchor] else ""
    uses[anchor] += 1
    return f"{match[1]} {title} {{#{label(page, anchor)}{number}}}"


def converted(text, page, root, uses):
    """Text without code blocks. Links may span lines."""
    text = HEADING.sub(lambda match: labelled_heading(match, page, uses), text)
    return LINK.sub(lambda match: converted_link(match, page, root), text)


def main():
    page = pathlib.Path(sys.argv[1]).resolve()
    root = pathlib.Path(__file__).resolve().parent.parent
    parts = re.split(r"(^```.*?^```$)", page.read_text(), flags=re.MULTILINE | re.DOTALL)
    uses = collections.Counter()
    for number, part in enumerate(parts):
        is_code = number % 2 == 1
        sys.stdout.write(part if is_code else converted(part, page, root, uses))


if __name__ == "__main__":
    main()
