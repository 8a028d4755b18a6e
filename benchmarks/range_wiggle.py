#!/usr/bin/python3
# SPDX-FileCopyrightText: 2026 the tofmap authors
# SPDX-License-Identifier: BSD-3-Clause
"""Measures the effect of a periodic error on trajectories, with and without loops or calibration.

    benchmarks/range_wiggle.py BUILD_DIR SEQ...
    benchmarks/range_wiggle.py --calibrated BUILD_DIR SEQ...

The correlation function of real cameras is not a pure sine, so that their ranges have an error of
some centimetres with four periods per wavelength. Such an error, a sin(8 pi phase), is added to
both phase images of copies of the recordings, which must have ground truth. Needs Debian's
python3-numpy and python3-opencv.
"""
import json
import os
import shutil
import subprocess
import sys
import tempfile

import cv2
import numpy

ERRORS_M = (0, 0.01, 0.03)
SPEED_OF_LIGHT_M_S = 299792458.0
NO_RETURN = 65535


def frequencies_hz(sequence):
    found = {}
    with open(f"{sequence}/sequence.yaml", encoding="utf-8") as file:
        for line in file:
            name, _, value = line.strip().partition(":")
            if name.startswith("frequency_"):
                found[name] = float(value)
    return found["frequency_a_hz"], found["frequency_b_hz"]


def with_wiggle(sequence, out, error_m):
    shutil.copytree(sequence, out, ignore=shutil.ignore_patterns("phase_*", "label_truth"))
    for folder, frequency in zip(("phase_a", "phase_b"), frequencies_hz(sequence)):
        os.mkdir(f"{out}/{folder}")
        error_cycles = error_m * 2 * frequency / SPEED_OF_LIGHT_M_S
        for name in os.listdir(f"{sequence}/{folder}"):
            stored = cv2.imread(f"{sequence}/{folder}/{name}", cv2.IMREAD_UNCHANGED)
            cycles = stored / 65535.0
            cycles = (cycles + error_cycles * numpy.sin(8 * numpy.pi * cycles)) % 1
            wiggled = numpy.minimum(numpy.round(65535 * cycles), NO_RETURN - 1)
            wiggled[stored == NO_RETURN] = NO_RETURN
            cv2.imwrite(f"{out}/{folder}/{name}", wiggled.astype(numpy.uint16))


def errors_mm(tofmap, sequence, out, *settings):
    subprocess.run([tofmap, "evaluate", sequence, "--out", out, "--quiet",
                    "--set", "evaluation.methods=joint", "--set", "pictures.frames=0",
                    *(word for one in settings for word in ("--set", one))],
                   check=True, stdout=subprocess.DEVNULL)
    with open(f"{out}/report.json", encoding="utf-8") as file:
        report = json.load(file)
    return (1000 * report["trajectory"]["joint"]["ate_rmse_m"],
            1000 * report["map"]["joint"]["accuracy_m"])


def with_and_without_loops(tofmap, folder):
    return [errors_mm(tofmap, f"{folder}/seq", f"{folder}/out", f"loops.close={close}")
            for close in ("false", "true")]


def calibrated(tofmap, folder):
    """Errors without calibration, and calibrated on the recording itself by residual and by truth."""
    found = [errors_mm(tofmap, f"{folder}/seq", f"{folder}/out")]
    for reference in ("residual", "truth"):
        file = f"{folder}/{reference}.yaml"
        subprocess.run([tofmap, "calibrate", f"{folder}/seq", "--out", file, "--quiet",
                        "--set", f"calibration.reference={reference}",
                        "--set", "calibration.every_frame=10"],
                       check=True, stdout=subprocess.DEVNULL)
        found.append(errors_mm(tofmap, f"{folder}/seq", f"{folder}/out",
                               f"camera.calibration_file={file}"))
    return found


def main():
    words = sys.argv[1:]
    is_calibrated = words[0] == "--calibrated"
    tofmap, *sequences = words[1:] if is_calibrated else words
    tofmap += "/apps/tofmap"
    cases = "not calibrated; by the residual; by truth" if is_calibrated else "loops open; closed"
    print(f"| trajectory / map error, mm, {cases} | "
          + " | ".join(f"{100 * e:g} cm" for e in ERRORS_M) + " |")
    print("|---|" + "---|" * len(ERRORS_M))
    for sequence in sequences:
        cells = []
        for error_m in ERRORS_M:
            with tempfile.TemporaryDirectory() as folder:
                with_wiggle(sequence, f"{folder}/seq", error_m)
                found = (calibrated if is_calibrated else with_and_without_loops)(tofmap, folder)
            cells.append("; ".join(f"{ate:.1f} / {map_error:.1f}" for ate, map_error in found))
        print(f"| {os.path.basename(os.path.normpath(sequence))} | " + " | ".join(cells) + " |",
              flush=True)


if __name__ == "__main__":
    main()
