#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 the tofmap authors
# SPDX-License-Identifier: BSD-3-Clause
"""Reads every shipped experiment, and runs a small one.

Usage: experiment_test.py SOURCE_DIR BUILD_DIR. Ends with 77 where python3-yaml is missing.
"""
import pathlib
import subprocess
import sys
import tempfile
import unittest

try:
    import yaml
except ImportError as missing:
    print(f"skipped: {missing}; install python3-yaml")
    sys.exit(77)

SOURCE, BUILD = (pathlib.Path(argument) for argument in sys.argv[1:3])
SMALL = {
    "title": "A small one", "scenes": ["wall"], "seeds": [1, 2], "frames": 2,
    "methods": ["none", "pixel"], "baseline": "none", "down_to": "unwrapping",
    "fixed": {"simulator.width_px": 32, "simulator.height_px": 24},
    "vary": {"noise": {"little": {"simulator.range_noise_m": 0.01},
                       "much": {"simulator.range_noise_m": 0.3}}},
    "measures": ["unwrapping.wrong_wrap_percent"],
}


def experiment(*arguments):
    return subprocess.run([sys.executable, SOURCE / "benchmarks/experiment.py", *arguments],
                          capture_output=True, text=True, check=False)


class Experiments(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def write(self, **changes):
        file = self.folder / "small.yaml"
        file.write_text(yaml.safe_dump({**SMALL, **changes}, sort_keys=False), encoding="utf-8")
        return file

    def test_shipped_files_are_read(self):
        files = sorted((SOURCE / "configs/experiments").glob("*.yaml"))
        self.assertGreaterEqual(len(files), 3)
        done = experiment("--check", *files)
        self.assertEqual(done.returncode, 0, done.stderr)

    def test_a_table_is_printed_and_runs_are_kept(self):
        out = self.folder / "out"
        done = experiment(self.write(), BUILD, out)
        self.assertEqual(done.returncode, 0, done.stderr)
        rows = [line for line in done.stdout.splitlines() if line.startswith("| wall")]
        self.assertEqual([row.split("|")[2].strip() for row in rows], ["little", "much"])
        self.assertIn("±", rows[0])
        kept = {file: file.stat().st_mtime_ns for file in out.iterdir()}
        self.assertEqual(len(kept), 4, "scenes x variants x seeds")
        next(iter(kept)).unlink()
        again = experiment(self.write(), BUILD, out)
        self.assertEqual([line for line in again.stdout.splitlines() if line.startswith("| wall")],
                         rows)
        renewed = [file for file, time in kept.items() if file.stat().st_mtime_ns != time]
        self.assertEqual(len(renewed), 1, "only what was missing is run again")

    def test_one_recording_makes_one_table_of_all_measures(self):
        measures = {"unwrapping.wrong_wrap_percent": "wrong, %", "unwrapping.coverage_percent": "kept, %"}
        file = self.write(vary={}, baseline=None, measures=measures)
        done = experiment(file, BUILD, self.folder / "out")
        self.assertEqual(done.returncode, 0, done.stderr)
        rows = [line for line in done.stdout.splitlines() if line.startswith("|")]
        self.assertEqual(rows[0], "| method | wrong, % | kept, % |")
        self.assertEqual([row.split("|")[1].strip() for row in rows[2:]], ["`none`", "`pixel`"])
        self.assertIn("100 ± 0", rows[2], "nothing is filtered, so everything is kept")

    def test_what_is_no_experiment_is_refused(self):
        for changes in ({"seeds": []}, {"baseline": "joint"}, {"colour": "red"},
                        {"measures": ["wrong"]}, {"vary": {"noise": [1, 2]}}):
            with self.subTest(changes):
                done = experiment("--check", self.write(**changes))
                self.assertEqual(done.returncode, 3)
                self.assertIn("small.yaml", done.stderr)

    def test_a_run_that_fails_is_named(self):
        done = experiment(self.write(scenes=["nowhere"]), BUILD, self.folder / "out")
        self.assertEqual(done.returncode, 3)
        self.assertIn("nowhere", done.stderr)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1], verbosity=2)
