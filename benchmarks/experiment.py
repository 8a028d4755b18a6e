#!/usr/bin/python3
# SPDX-FileCopyrightText: 2026 the tofmap authors
# SPDX-License-Identifier: BSD-3-Clause
"""Runs the experiment that a file describes, and prints its tables.

    benchmarks/experiment.py FILE BUILD_DIR OUT_DIR [--jobs N] [--plot PICTURE]
    benchmarks/experiment.py --check FILE ...

Every combination of scenes, variants and seeds is a run of `tofmap simulate` and `tofmap evaluate`.
OUT_DIR keeps only the report.json of each run. Runs whose report exists are skipped, so that an
interrupted experiment can be continued. configs/experiments/README.md describes the files. Needs
Debian's python3-yaml, and python3-matplotlib for plots.
"""
import argparse
import concurrent.futures
import dataclasses
import hashlib
import itertools
import json
import math
import os
import pathlib
import re
import shutil
import statistics
import subprocess
import sys
import tempfile

import yaml

KEYS = {"title", "scenes", "seeds", "frames", "vary", "fixed", "methods", "baseline", "measures",
        "down_to"}


class Wrong(Exception):
    """The file does not describe an experiment."""


@dataclasses.dataclass(frozen=True)
class Run:
    """One recording, and how it is evaluated."""
    scene: str
    variant: tuple[str, ...]  # one label per axis
    seed: int
    options: tuple[tuple[str, object], ...]

    def settings(self, of_simulator):
        return [word for name, value in self.options
                if name.startswith("simulator.") == of_simulator
                for word in ("--set", f"{name}={value}")]


class Experiment:
    def __init__(self, file):
        with open(file, encoding="utf-8") as text:
            self.content = yaml.safe_load(text)
        content = self.content
        if not isinstance(content, dict) or set(content) - KEYS:
            raise Wrong(f"{file}: keys must be some of {', '.join(sorted(KEYS))}")
        for key in ("title", "scenes", "seeds", "methods", "measures"):
            if not content.get(key):
                raise Wrong(f"{file}: {key} is missing")
        self.title = content["title"]
        self.methods = content["methods"]
        measures = content["measures"]  # a list of names, or a mapping from names to labels
        self.measures = ({name: str(label) for name, label in measures.items()}
                         if isinstance(measures, dict) else {name: name for name in measures})
        self.baseline = content.get("baseline")
        self.axes = content.get("vary") or {}
        if self.baseline and self.baseline not in self.methods:
            raise Wrong(f"{file}: baseline {self.baseline} is not one of the methods")
        for measure in self.measures:
            if not re.fullmatch(r"\w+\.\w+", measure):
                raise Wrong(f"{file}: measure {measure} is not a group.metric of report.json")
        for axis, variants in self.axes.items():
            if not isinstance(variants, dict) or not all(
                    isinstance(options, dict) for options in variants.values()):
                raise Wrong(f"{file}: {axis} must map labels to options")

    def variants(self):
        """Yields the labels of each combination of variants, and its options."""
        fixed = self.content.get("fixed") or {}
        for labels in itertools.product(*(list(variants) for variants in self.axes.values())):
            options = dict(fixed)
            for axis, label in zip(self.axes, labels):
                options.update(self.axes[axis][label])
            yield labels, options

    def runs(self):
        for scene, (labels, options), seed in itertools.product(
                self.content["scenes"], self.variants(), self.content["seeds"]):
            yield Run(scene, tuple(str(label) for label in labels), seed,
                      tuple(sorted(options.items())))

    def commands(self, run, tofmap, folder):
        frames = ["--frames", str(self.content["frames"])] if "frames" in self.content else []
        return ([tofmap, "simulate", run.scene, "--seed", str(run.seed), *frames, "--out",
                 f"{folder}/seq", "--quiet", *run.settings(of_simulator=True)],
                [tofmap, "evaluate", f"{folder}/seq", "--out", f"{folder}/out", "--quiet", "--set",
                 "evaluation.methods=" + " ".join(self.methods), "--set", "pictures.frames=0",
                 "--set", f"evaluation.down_to={self.content.get('down_to', 'map')}", "--set",
                 "report.frames=0", *run.settings(of_simulator=False)])

    def report_file(self, run, out):
        """The report file of a run. Its name depends on the options, so changed runs run anew."""
        words = itertools.chain.from_iterable(self.commands(run, "tofmap", ""))
        return out / (hashlib.sha256("\0".join(words).encode()).hexdigest()[:16] + ".json")


def carry_out(experiment, run, tofmap, out):
    """Carries out a run unless its report exists. Returns the report, or None, and the error."""
    kept = experiment.report_file(run, out)
    if not kept.exists():
        with tempfile.TemporaryDirectory(dir=out) as folder:
            for command in experiment.commands(run, tofmap, folder):
                done = subprocess.run(command, capture_output=True, text=True, check=False,
                                      env={**os.environ, "OMP_NUM_THREADS": "1"})
                if done.returncode != 0:
                    return None, done.stderr.strip()
            shutil.move(f"{folder}/out/report.json", f"{kept}.partial")
        os.replace(f"{kept}.partial", kept)
    return json.loads(kept.read_text(encoding="utf-8")), ""


def carry_out_all(experiment, tofmap, out, jobs):
    runs = list(experiment.runs())
    reports = {}
    with concurrent.futures.ThreadPoolExecutor(jobs) as pool:
        futures = {pool.submit(carry_out, experiment, run, tofmap, out): run for run in runs}
        try:
            for count, future in enumerate(concurrent.futures.as_completed(futures), 1):
                run = futures[future]
                report, trouble = future.result()
                if report is None:
                    print(f"{run.scene} {' '.join(run.variant)}, seed {run.seed}: {trouble}",
                          file=sys.stderr)
                else:
                    reports[run] = report
                print(f"run {count} of {len(runs)}", file=sys.stderr)
        except KeyboardInterrupt:
            pool.shutdown(cancel_futures=True)
            raise
    return reports


def value_of(report, measure, method):
    group, metric = measure.split(".")
    value = report.get(group, {}).get(method, {}).get(metric)
    return math.nan if value is None else value


def known(values):
    return [value for value in values if not math.isnan(value)]


def cell(values):
    """The mean with three digits, standard deviation, and number of seeds without a value."""
    there = known(values)
    if not there:
        return "-"
    mean = statistics.mean(there)
    spread = statistics.stdev(there) if len(there) > 1 else 0.0
    leading = max(abs(mean), spread)
    decimals = max(0, 2 - math.floor(math.log10(leading))) if leading > 0 else 0
    without = len(values) - len(there)
    return f"{mean:.{decimals}f} ± {spread:.{decimals}f}" + (f", {without} without" if without else "")


def rows_of(experiment, reports):
    """The reports by scene and variant, in the order of the seeds."""
    rows = {}
    for run in experiment.runs():
        if run in reports:
            rows.setdefault((run.scene, *run.variant), []).append(reports[run])
    return rows


def cell_of_method(experiment, seeds, measure, method):
    values = [value_of(report, measure, method) for report in seeds]
    text = cell(values)
    if experiment.baseline not in (None, method):
        text += " (" + cell([value - value_of(report, measure, experiment.baseline)
                             for value, report in zip(values, seeds)]) + ")"
    return text


def print_rows(head, rows):
    print("| " + " | ".join(head) + " |")
    print("|---" * len(head) + "|")
    for row in rows:
        print("| " + " | ".join(row) + " |")


def print_tables(experiment, reports):
    """Prints a table per measure or, for a single scene without variants, one for all measures."""
    print(f"{experiment.title}. Mean and standard deviation over {len(experiment.content['seeds'])} "
          "seeds" + (f"; in brackets the difference from `{experiment.baseline}`, seed by seed"
                     if experiment.baseline else "") + ".\n")
    rows = rows_of(experiment, reports)
    if len(rows) == 1:
        seeds, = rows.values()
        print_rows(("method", *experiment.measures.values()), (
            (f"`{method}`", *(cell_of_method(experiment, seeds, measure, method)
                              for measure in experiment.measures))
            for method in experiment.methods))
        return
    for measure, label in experiment.measures.items():
        print_rows((label, *experiment.axes, *(f"`{method}`" for method in experiment.methods)), (
            (*names, *(cell_of_method(experiment, seeds, measure, method)
                       for method in experiment.methods))
            for names, seeds in rows.items()))
        print()


def plot(experiment, reports, picture):
    """Draws a panel per measure: the mean of each method, and a bar from least to greatest value."""
    import matplotlib
    matplotlib.use("Agg")
    from matplotlib import pyplot
    colors = ("#000000", "#0072b2", "#d55e00", "#009e73", "#cc79a7", "#56b4e9")  # Okabe and Ito
    markers = "xsd^ov"
    rows = rows_of(experiment, reports)
    longest_name = max(len(name) for names in rows for name in names)
    inches_a_row = max(0.25 * len(experiment.methods), 0.09 * longest_name)
    figure, panels = pyplot.subplots(len(experiment.measures), 1, squeeze=False, figsize=(
        max(6, 0.8 + inches_a_row * len(rows)), 0.3 + 3.2 * len(experiment.measures)))
    apart = 0.8 / len(experiment.methods)
    for panel, (measure, label) in zip(panels[:, 0], experiment.measures.items()):
        for i, method in enumerate(experiment.methods):
            places, found = [], []
            for row, seeds in enumerate(rows.values()):
                values = known(value_of(report, measure, method) for report in seeds)
                if values:
                    places.append(row + (i + 0.5) * apart - 0.4)
                    found.append((min(values), statistics.mean(values), max(values)))
            panel.errorbar(places, [mean for _, mean, _ in found],
                           yerr=[[mean - least for least, mean, _ in found],
                                 [most - mean for _, mean, most in found]],
                           linestyle="none", marker=markers[i % len(markers)], label=method,
                           color=colors[i % len(colors)], capsize=2)
        panel.set_ylabel(label)
        panel.set_xticks(range(len(rows)), ["\n".join(names) for names in rows])
        panel.set_yscale("log")
        panel.grid(axis="y", alpha=0.4)
        for between in range(1, len(rows)):
            panel.axvline(between - 0.5, color="0.85", linewidth=0.8)
        panel.set_xlim(-0.5, len(rows) - 0.5)
    panels[0, 0].set_title(experiment.title, loc="left")
    panels[0, 0].legend(ncols=len(experiment.methods), fontsize="small", loc="lower right",
                        bbox_to_anchor=(1, 1), borderaxespad=0.2)
    figure.tight_layout()
    figure.savefig(picture, dpi=130)


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n", maxsplit=1)[0])
    parser.add_argument("--check", nargs="+", metavar="FILE", help="check these files without running them")
    parser.add_argument("file", nargs="?")
    parser.add_argument("build_dir", nargs="?", type=pathlib.Path)
    parser.add_argument("out_dir", nargs="?", type=pathlib.Path)
    parser.add_argument("--jobs", type=int, default=os.cpu_count())
    parser.add_argument("--plot", metavar="PICTURE")
    arguments = parser.parse_args()
    try:
        if arguments.check:
            for file in arguments.check:
                print(f"{file}: {len(list(Experiment(file).runs()))} runs")
            return 0
        if not arguments.out_dir:
            parser.error("FILE, BUILD_DIR and OUT_DIR are needed")
        experiment = Experiment(arguments.file)
        arguments.out_dir.mkdir(parents=True, exist_ok=True)
        reports = carry_out_all(experiment, str(arguments.build_dir / "apps" / "tofmap"),
                                arguments.out_dir, arguments.jobs)
    except (Wrong, OSError, yaml.YAMLError) as error:
        print(f"experiment: {error}", file=sys.stderr)
        return 3
    except KeyboardInterrupt:
        print("experiment: interrupted; the same command continues", file=sys.stderr)
        return 130
    print_tables(experiment, reports)
    if arguments.plot:
        plot(experiment, reports, arguments.plot)
    return 0 if len(reports) == len(list(experiment.runs())) else 3


if __name__ == "__main__":
    sys.exit(main())
