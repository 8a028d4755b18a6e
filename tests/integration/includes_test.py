#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 the tofmap authors
# SPDX-License-Identifier: BSD-3-Clause
"""Sources include the headers of the names listed here, which other headers would hide.

A file that uses such a name must include its header itself or by headers of the project.
"""
import collections
import pathlib
import re
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
FOLDERS = ("apps", "benchmarks", "examples", "modules", "tests")

# Headers, as patterns, and the names that want them.
NAMES = {
    "algorithm": r"std::(min|max|minmax|clamp|sort|stable_sort|copy|copy_n|fill|fill_n|find|"
                 r"find_if|transform|generate|any_of|all_of|none_of|count|count_if|nth_element|"
                 r"max_element|min_element|minmax_element|lower_bound|upper_bound|reverse|unique|"
                 r"remove_if|shuffle|equal|partition|for_each)\b(?=[(<])|"
                 r"std::ranges::(?!greater|less|equal_to|begin|end|size|data|empty|range|view|"
                 r"subrange|distance|next)[a-z_]+",
    "array": r"std::(array|to_array)\b",
    "atomic": r"std::atomic\b",
    "bit": r"std::(bit_cast|popcount|countr_zero|countl_zero|bit_width)\b",
    "charconv": r"std::(from_chars|to_chars)\b",
    "chrono": r"std::chrono::",
    "cmath": r"std::(sqrt|sin|cos|tan|atan2|atan|asin|acos|isnan|isfinite|hypot|floor|ceil|round|"
             r"lround|pow|exp|log|log2|log10|fmod|remainder|cbrt|copysign|expm1|log1p|erf|erfc|"
             r"trunc|rint|lrint)\b",
    "complex": r"std::(complex|polar|arg)\b",
    "condition_variable": r"std::condition_variable\b",
    "cstdint": r"std::u?int(8|16|32|64)_t\b",
    "cstring": r"std::(memcpy|memcmp|memset|strlen|strerror)\b",
    "deque": r"std::deque\b",
    "filesystem": r"std::filesystem::",
    "fstream": r"std::[io]?fstream\b",
    "functional": r"std::(function|hash|less|greater|plus|invoke|ref|cref|bind_front|not_fn|"
                  r"identity|reference_wrapper)\b|std::ranges::(greater|less|equal_to)\b",
    "iomanip": r"std::(setw|setprecision|setfill)\b",
    "iostream": r"std::(cout|cerr|cin)\b",
    "limits": r"std::numeric_limits\b",
    "map": r"std::map\b",
    "memory": r"std::(unique_ptr|shared_ptr|weak_ptr|make_unique|make_shared)\b",
    "mutex": r"std::(mutex|lock_guard|unique_lock|scoped_lock|once_flag)\b",
    "numbers": r"std::numbers::",
    "numeric": r"std::(accumulate|iota|reduce|inner_product|partial_sum|transform_reduce|"
               r"midpoint)\b",
    "optional": r"std::(optional|nullopt)\b",
    "queue": r"std::(queue|priority_queue)\b",
    "random": r"std::(mt19937(_64)?|normal_distribution|uniform_\w+_distribution)\b",
    "ranges": r"std::(views|ranges::views)::",
    "set": r"std::set\b",
    "span": r"std::span\b",
    "sstream": r"std::[io]?stringstream\b",
    "stdexcept": r"std::(runtime_error|invalid_argument|logic_error|out_of_range)\b",
    "string": r"std::(string|to_string|stoi|stod|getline)\b",
    "string_view": r"std::string_view\b",
    "thread": r"std::(thread|jthread|this_thread)\b",
    "tuple": r"std::(tuple|tie|make_tuple|apply)\b",
    "unordered_map": r"std::unordered_map\b",
    "unordered_set": r"std::unordered_set\b",
    "variant": r"std::(variant|visit|holds_alternative|monostate)\b",
    "vector": r"std::vector\b",
    "Eigen/.*": r"\bEigen::",
    "gmock/.*": r"\btesting::(?!Test|Values|Combine|Range|Bool|TempDir|UnitTest|Message|Assertion|"
                r"internal)",
    "g(mock|test)/.*": r"\b(TEST|TEST_F|TEST_P)\(|\b(EXPECT|ASSERT)_[A-Z]+\(",
    "nlohmann/.*": r"\bnlohmann::",
    "pcl/.*": r"\bpcl::",
}


def sources():
    listed = subprocess.run(["git", "-C", ROOT, "ls-files", "*.cpp", "*.hpp"], capture_output=True,
                            text=True, check=False)
    if listed.returncode == 0:
        return [ROOT / name for name in listed.stdout.split()]
    return [path for folder in FOLDERS for path in (ROOT / folder).rglob("*.[ch]pp")]


def missing_from(code, included):
    """Pairs of a header that code lacks and a name that wants it."""
    code = re.sub(r'"(\\.|[^"\\\n])*"', "", re.sub(r"//.*", "", code))
    for header, names in NAMES.items():
        used = re.search(names, code)
        if used and not any(re.fullmatch(header, one) for one in included):
            yield header, used[0]


class Includes:
    """What each source includes, directly and by headers of the project."""

    def __init__(self, paths):
        self.code = {path: path.read_text(encoding="utf-8") for path in paths}
        self.folders = [ROOT / "apps", ROOT / "tests", ROOT / "benchmarks",
                        *(ROOT / "modules").glob("*/include"), *(ROOT / "modules").glob("*/src")]

    def of(self, path):
        """The headers of others that a source includes."""
        found, reached, waiting = set(), {path}, collections.deque([path])
        while waiting:
            file = waiting.popleft()
            for name in re.findall(r'^\s*#include [<"]([^>"]+)[>"]', self.code[file], re.MULTILINE):
                own = [folder / name for folder in (file.parent, *self.folders)
                       if folder / name in self.code]
                if not own:
                    found.add(name)
                elif own[0] not in reached:
                    reached.add(own[0])
                    waiting.append(own[0])
        return found


def main():
    assert list(missing_from("std::max(1, 2); // std::vector", {"vector"})) == [
        ("algorithm", "std::max")]
    assert not list(missing_from("Eigen::Matrix3d m;", {"Eigen/Core"}))
    includes = Includes(sources())
    assert len(includes.code) > 500
    found = [f"{path.relative_to(ROOT)} uses {name} without <{header}>"
             for path, code in includes.code.items()
             for header, name in missing_from(code, includes.of(path))]
    if found:
        sys.exit("\n".join(found))


if __name__ == "__main__":
    main()
