#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 the tofmap authors
# SPDX-License-Identifier: BSD-3-Clause
"""Mutation testing: changes one line of modules/ at a time and prints which tests notice it.

Each mutant flips a comparison, swaps an operator, drops a term, changes a constant, negates a
condition or removes a call. The tests of the mutated module run first, then all others. The
committed state is checked out into a work tree of its own in the build folder, so that the tree
you work in stays as it is. Prints a line of a Markdown table for each mutant.

    scripts/mutation.py --build build-mutation --count 50 --seed 1

Needs what scripts/packages.sh --tests installs.
"""

import argparse
import os
import pathlib
import random
import re
import signal
import subprocess
import sys
import time

ROOT = pathlib.Path(__file__).resolve().parent.parent

# The pattern, replacement and name of each mutation. clang-format puts spaces around binary
# operators, which distinguishes them from template brackets and references.
SWAPS = [
    (r" < ", " >= ", "flip comparison"),
    (r" > ", " <= ", "flip comparison"),
    (r" <= ", " > ", "flip comparison"),
    (r" >= ", " < ", "flip comparison"),
    (r" == ", " != ", "flip comparison"),
    (r" != ", " == ", "flip comparison"),
    (r" && ", " || ", "swap logic"),
    (r" \|\| ", " && ", "swap logic"),
    (r" \+ ", " - ", "swap arithmetic"),
    (r" - ", " + ", "swap arithmetic"),
    (r" \* ", " / ", "swap arithmetic"),
    (r" / ", " * ", "swap arithmetic"),
    (r" \+= ", " -= ", "swap arithmetic"),
    (r" \*= ", " /= ", "swap arithmetic"),
    (r" [+-] [\w.:\[\]]+(?=[;,)])", "", "drop term"),
    (r"std::min\b", "std::max", "swap bounds"),
    (r"std::max\b", "std::min", "swap bounds"),
    (r"\btrue\b", "false", "flip truth"),
    (r"\bfalse\b", "true", "flip truth"),
]
CONSTANT = re.compile(r"(?<=[=(,] )\d+(\.\d+)?(e-?\d+)?F?(?=[;,)])")
CONDITION = re.compile(r"^(\s*(?:\} else )?if )\((?!const|auto)(.*)\)( \{| return.*;| continue;)$")
CALL = re.compile(r"^\s+[\w.>:-]+\(.*\);$")
SKIPPED = re.compile(r"^\s*(//|#|\*)|template|operator|static_assert|throw |UsageError|InputError")


def mutations_of(line):
    """All ways to break this line: (new line, name)."""
    if SKIPPED.search(line) or '"' in line:
        return []
    code = line.split("  //")[0]
    found = []
    for pattern, replacement, name in SWAPS:
        for match in re.finditer(pattern, code):
            found.append((code[: match.start()] + replacement + code[match.end() :], name))
    for match in CONSTANT.finditer(code):
        number = match.group()
        changed = "1" if number in ("0", "0.0") else f"2 * {number}"
        found.append((code[: match.start()] + changed + code[match.end() :], "change constant"))
    condition = CONDITION.match(code)
    if condition:
        found.append(
            (f"{condition[1]}(!({condition[2]})){condition[3]}", "negate condition"))
    if CALL.match(code) and not code.strip().startswith("return"):
        found.append((re.match(r"\s*", code).group() + ";", "remove call"))
    return found


def all_mutants(source):
    mutants = []
    for path in sorted(source.glob("modules/*/src/**/*.cpp")):
        if "scene" in path.name:
            continue  # furniture of simulated rooms
        lines = path.read_text().split("\n")
        in_fields = False
        for number, line in enumerate(lines):
            # Tables of options have ranges that only refuse wrong options.
            in_fields = (in_fields or "::fields()" in line) and line != "}"
            if in_fields:
                continue
            is_whole = number > 0 and re.search(r"([;{}]|//.*)$", lines[number - 1]) is not None
            for text, name in mutations_of(line):
                if name == "remove call" and not is_whole:
                    continue
                mutants.append((path, number, line, text, name))
    return mutants


def run(command, seconds, **options):
    """The finished process, or None if it had to be ended, with all that it had started."""
    with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
                          start_new_session=True, **options) as process:
        try:
            output, _ = process.communicate(timeout=seconds)
        except subprocess.TimeoutExpired:
            os.killpg(process.pid, signal.SIGKILL)
            process.communicate()
            return None
    return subprocess.CompletedProcess(command, process.returncode, output)


class Suite:
    """The tests of one build folder."""

    def __init__(self, build, excluded):
        self.build = build
        self.excluded = ["-LE", excluded] if excluded else []
        self.environment = {**os.environ, "OMP_NUM_THREADS": "2"}

    def compiles(self, target):
        done = run(["cmake", "--build", self.build, "--target", target], 3600)
        return done is not None and done.returncode == 0

    def failure_in(self, module):
        """The first failing test of a module; None if all pass."""
        program = self.build / "tests" / module / f"test_{module}"
        done = run([program, "--gtest_fail_fast", "--gtest_brief=1"], 600, env=self.environment)
        if done is None:
            return f"{module}: no end"
        failed = re.search(r"\[  FAILED  \] (\S+)", done.stdout)
        if failed:
            return failed.group(1).rstrip(",")
        return None if done.returncode == 0 else f"{module}: crash"

    def failure_anywhere(self):
        done = run(["ctest", "--test-dir", self.build, "--stop-on-failure", "-j", "2",
                    *self.excluded], 3600, env=self.environment)
        if done is None:
            return "no end"
        if done.returncode == 0:
            return None
        failed = re.search(r"^\s*\d+ - (\S+) ", done.stdout, re.MULTILINE)
        return failed.group(1) if failed else "a test"


def outcome(suite, module):
    test = f"test_{module}"
    if not suite.compiles(test):
        return None
    failure = suite.failure_in(module)
    if failure is None:
        if not suite.compiles("all"):
            return None
        failure = suite.failure_anywhere()
    return failure or "**survives**"


def prepare(build, excluded):
    source = build / "source"
    if not source.exists():
        subprocess.run(["git", "-C", ROOT, "worktree", "prune"], check=True)
        subprocess.run(["git", "-C", ROOT, "worktree", "add", "--detach", source], check=True,
                       capture_output=True)
    else:
        head = subprocess.check_output(["git", "-C", ROOT, "rev-parse", "HEAD"], text=True).strip()
        subprocess.run(["git", "-C", source, "checkout", "-q", "--force", head], check=True)
    tests = build / "tests-build"
    subprocess.run(["cmake", "-S", source, "-B", tests, "-G", "Ninja", "-DCMAKE_BUILD_TYPE=Release",
                    "-DTOFMAP_BUILD_TESTS=ON", "-DTOFMAP_PRECOMPILE_HEADERS=ON",
                    # Shared libraries: only the changed one is linked again.
                    "-DBUILD_SHARED_LIBS=ON", "-DCMAKE_LINK_DEPENDS_NO_SHARED=ON",
                    "-DCMAKE_CXX_COMPILER_LAUNCHER=ccache"], check=True, capture_output=True)
    suite = Suite(tests, excluded)
    if not suite.compiles("all"):
        sys.exit("mutation.py: the committed state does not build")
    failure = suite.failure_anywhere()
    if failure:
        sys.exit(f"mutation.py: {failure} fails without a mutant")
    return source, suite


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--build", type=pathlib.Path, default=ROOT / "build-mutation")
    parser.add_argument("--count", type=int, default=50, help="mutants that compile")
    parser.add_argument("--seed", type=int, default=1, help="which lines are broken")
    parser.add_argument("--modules", nargs="*", help="only these (default: all)")
    parser.add_argument("--exclude", help="leave out tests whose label matches, e.g. integration")
    arguments = parser.parse_args()
    source, suite = prepare(arguments.build.resolve(), arguments.exclude)
    mutants = all_mutants(source)
    if arguments.modules:
        mutants = [m for m in mutants if m[0].relative_to(source).parts[1] in arguments.modules]
    random.Random(arguments.seed).shuffle(mutants)

    print("| line | mutation | becomes | noticed by |\n|---|---|---|---|", flush=True)
    killed = survived = 0
    for path, number, line, text, name in mutants:
        if killed + survived == arguments.count:
            break
        place = path.relative_to(source)
        module = place.parts[1]
        original = path.read_text()
        lines = original.split("\n")
        lines[number] = text
        began = time.monotonic()
        try:
            path.write_text("\n".join(lines))
            noticed_by = outcome(suite, module)
        finally:
            path.write_text(original)
        if noticed_by is None:
            continue  # does not compile
        survived += noticed_by == "**survives**"
        killed += noticed_by != "**survives**"
        shown = text.strip().replace("|", "\\|")
        print(f"| {place.relative_to('modules')}:{number + 1} | {name} | `{shown}` "
              f"| {noticed_by} |", flush=True)
        print(f"{time.monotonic() - began:.0f} s", file=sys.stderr, flush=True)
    print(f"\n{killed} of {killed + survived} mutants are noticed.")


if __name__ == "__main__":
    main()
