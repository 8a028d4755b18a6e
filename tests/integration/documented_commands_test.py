#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 the tofmap authors
# SPDX-License-Identifier: BSD-3-Clause
"""Runs every tofmap command that the documentation shows in a block, on something small.

Usage: documented_commands_test.py SOURCE_DIR TOFMAP. Ends with 77 where python3-pil is missing. The
commands of one document run in one folder, in their order, with words like SEQ and DIR replaced by
what is there.
"""
import itertools
import pathlib
import re
import shlex
import subprocess
import sys
import tempfile
import unittest

try:
    from PIL import Image
except ImportError as missing:
    print(f"skipped: {missing}; install python3-pil")
    sys.exit(77)

SOURCE, TOFMAP = (pathlib.Path(argument).resolve() for argument in sys.argv[1:3])
FAST = ["--set", "simulator.subpixels=1"]
SMALL = ["--set", "simulator.width_px=44", "--set", "simulator.height_px=36"]
# Large and long enough for a recording to be found in the map of another.
KNOWN = ["--frames", "60", "--set", "simulator.width_px=88", "--set", "simulator.height_px=72",
         *FAST]

# Two frames of correlation images of 4 x 3 pixels.
DESCRIPTION = """format: tofmap-correlation
version: 1
camera: {width: 4, height: 3, fx: 4, fy: 4, cx: 1.5, cy: 1}
frequencies_hz: [80.0e6]
step_angles_deg: [0, 90, 180, 270]
phase_sign: 1
steps: single_ended
data: {files: images.bin, type: uint8, axes: [frame, step, row, column]}
"""

# A room of 4 x 4 x 3 m, looked at from inside.
MESH = """ply
format ascii 1.0
element vertex 8
property float x
property float y
property float z
element face 6
property list uchar int vertex_indices
end_header
0 0 0
4 0 0
4 4 0
0 4 0
0 0 3
4 0 3
4 4 3
0 4 3
4 0 1 2 3
4 7 6 5 4
4 0 4 5 1
4 1 5 6 2
4 2 6 7 3
4 3 7 4 0
"""


def documents():
    return [SOURCE / "README.md", *sorted((SOURCE / "docs").glob("*.md")),
            *sorted((SOURCE / "datasets").glob("*/README.md"))]


def commands_of(document):
    """Lines of blocks that begin with tofmap, without their comments."""
    blocks = re.findall(r"^```\w*\n(.*?)^```", document.read_text(encoding="utf-8"),
                        re.MULTILINE | re.DOTALL)
    for line in "".join(blocks).splitlines():
        if line.startswith("tofmap "):
            yield re.sub(r"\s#.*", "", line)


def write_tum_recording(folder):
    """Three depth images of a wall 2 m away, 5000 steps a metre."""
    (folder / "depth").mkdir(parents=True)
    depths, poses = [], []
    for i in range(3):
        Image.new("I;16", (64, 48), 10000).save(folder / f"depth/{i}.png")
        depths.append(f"{i}.0 depth/{i}.png\n")
        poses.append(f"{i}.0 0 0 0 0 0 0 1\n")
    (folder / "depth.txt").write_text("".join(depths), encoding="utf-8")
    (folder / "groundtruth.txt").write_text("".join(poses), encoding="utf-8")


def run(words, folder, stdout=None):
    return subprocess.run(words, cwd=folder, stdout=stdout or subprocess.DEVNULL,
                          stderr=subprocess.PIPE, text=True, check=False)


class DocumentedCommands(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        cls.common = pathlib.Path(folder.name)
        cls.sequence, cls.map = cls.common / "sequence", cls.common / "map"
        (cls.common / "room.ply").write_text(MESH, encoding="utf-8")
        (cls.common / "images.yaml").write_text(DESCRIPTION, encoding="utf-8")
        (cls.common / "images.bin").write_bytes(bytes(range(96)))
        for words in (["simulate", "room", "--frames", "8", "--out", cls.sequence, *SMALL],
                      ["map", cls.sequence, "--out", cls.map, "--pcd", "--set",
                       "map.min_observations=1"]):
            run([TOFMAP, *words], cls.common).check_returncode()
        cls.recordings = [cls.common / f"recording-{seed}" for seed in (1, 2)]
        cls.maps = [cls.common / f"map-{seed}" for seed in (1, 2)]
        for seed, (recording, of_it) in enumerate(zip(cls.recordings, cls.maps), 1):
            for words in (["simulate", "room", "--seed", str(seed), "--out", recording, *KNOWN],
                          ["map", recording, "--out", of_it]):
                run([TOFMAP, *words], cls.common).check_returncode()

    def replaced(self, words, folder):
        """The command with what is there in place of names, and smaller."""
        numbers, maps = itertools.count(), itertools.cycle(self.maps)
        inputs = {"SEQ": self.sequence, "DIR": self.map, "SCENE": "wall", "map.ply": "map.ply",
                  "URI": f"tofmap://{self.sequence}?speed=-1", "shop.ply": self.common / "room.ply",
                  "FORMAT": "correlation", "PATH": self.common / "images.yaml",
                  "out/demo/map": self.map, "out/demo/recording": self.sequence}
        if "MAP" in words:  # the map of one recording, and another recording of that room
            inputs["SEQ"] = self.recordings[1]
        out = [TOFMAP]
        for before, word in zip(words, words[1:]):
            is_output = before in ("--out", "--oni", "--screenshot")
            if is_output and word in ("SEQ", "DIR", "FILE"):
                word = f"result-{len(list(folder.iterdir()))}-{next(numbers)}"
                word += ".yaml" if words[1] == "calibrate" else ""
            elif word == "CLOUDS":
                out += [self.map / "map.ply", self.map / "map.pcd"]
                continue
            elif word == "MAP":
                word = next(maps)
            elif not is_output:
                word = inputs.get(word, word)
            out.append(word)
        if words[1] == "simulate":
            if "--frames" in out:
                del out[out.index("--frames"):out.index("--frames") + 2]
            if "kinect2" in out:  # packets have one size
                out += ["--frames", "2", *FAST]
            else:
                out += ["--frames", "8"] if "--from-tum" in out else ["--frames", "8", *SMALL]
        if words[1] == "view":
            if "--screenshot" not in words:
                out += ["--screenshot", f"view-{len(list(folder.iterdir()))}.png"]
            if "--frame" in words:
                out[out.index("--frame") + 1] = "4"
        return out

    def test_every_one_runs(self):
        count = 0
        for document in documents():
            with tempfile.TemporaryDirectory() as name:
                folder = pathlib.Path(name)
                (folder / "map.ply").write_bytes((self.map / "map.ply").read_bytes())
                write_tum_recording(folder / "rgbd_dataset_freiburg1_rpy")
                for line in commands_of(document):
                    words = shlex.split(line)
                    target = None
                    if ">" in words:
                        target = folder / words[words.index(">") + 1]
                        words = words[:words.index(">")]
                    with self.subTest(document=document.name, command=line):
                        with open(target or "/dev/null", "w", encoding="utf-8") as stdout:
                            done = run(self.replaced(words, folder), folder, stdout)
                        self.assertEqual(done.returncode, 0, done.stderr)
                        count += 1
        self.assertGreater(count, 30)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1], verbosity=2)
