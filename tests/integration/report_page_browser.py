#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 the tofmap authors
# SPDX-License-Identifier: BSD-3-Clause
"""Opens report.html of `map` and `evaluate` as a user does, in a headless Chromium.

Usage: report_page_browser.py TOFMAP RECORDING EXPECTED_PICTURE [--write]

The pages must load nothing and complain of nothing; the strip must step, the map turn, and what is
drawn of it look like EXPECTED_PICTURE, which --write makes anew. Ends with 77 where the browser is
missing.
"""

import base64
import io
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

try:
    from PIL import Image, ImageChops, ImageStat
    from selenium import webdriver
    from selenium.common.exceptions import WebDriverException
    from selenium.webdriver.chrome.service import Service
    from selenium.webdriver.common.action_chains import ActionChains
    from selenium.webdriver.common.by import By
    from selenium.webdriver.common.keys import Keys
except ImportError as missing:
    print(f"skipped: {missing}; install python3-selenium and python3-pil")
    sys.exit(77)

TOFMAP, RECORDING, EXPECTED = (pathlib.Path(argument) for argument in sys.argv[1:4])
WRITES_EXPECTED = "--write" in sys.argv


def open_browser(profile):
    options = webdriver.ChromeOptions()
    for argument in ("--headless", "--no-sandbox", "--disable-dev-shm-usage", "--hide-scrollbars",
                     "--use-angle=swiftshader", "--enable-unsafe-swiftshader",
                     "--window-size=1366,900", f"--user-data-dir={profile}"):
        options.add_argument(argument)
    options.set_capability("goog:loggingPrefs", {"browser": "ALL"})
    return webdriver.Chrome(service=Service("/usr/bin/chromedriver"), options=options)


def difference(a, b):
    """Mean difference of two pictures, 0 to 255, coarsely: single pixels do not count."""
    size = (86, 54)
    pair = [picture.convert("RGB").resize(size, Image.BOX) for picture in (a, b)]
    return sum(ImageStat.Stat(ImageChops.difference(*pair)).mean) / 3


class ReportPage(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(cls.folder.cleanup)
        cls.out = pathlib.Path(cls.folder.name)
        try:
            cls.browser = open_browser(cls.out / "profile")
        except WebDriverException as error:
            print(f"skipped: no browser: {error}; install chromium and chromium-driver")
            sys.exit(77)
        cls.addClassCleanup(cls.browser.quit)
        for command in ("map", "evaluate"):
            subprocess.run([TOFMAP, command, RECORDING, "--out", cls.out / command, "--quiet",
                            "--set", "pictures.frames=0", "--set", "report.frames=3"], check=True,
                           stdout=subprocess.DEVNULL)

    def open(self, command):
        self.browser.get((self.out / command / "report.html").as_uri())

    def picture(self):
        """What is drawn of the map, also where it is scrolled out of the window."""
        url = self.browser.execute_script(
            "return document.querySelector('.scene canvas').toDataURL('image/png')")
        return Image.open(io.BytesIO(base64.b64decode(url.split(",")[1])))

    def shown_frames(self):
        frames = self.browser.find_elements(By.CSS_SELECTOR, ".strip .frame")
        return [i for i, frame in enumerate(frames) if frame.is_displayed()]

    def click(self, selector):
        button = self.browser.find_element(By.CSS_SELECTOR, selector)
        self.browser.execute_script("arguments[0].scrollIntoView({block: 'center'})", button)
        button.click()

    def test_needs_nothing_else_and_complains_of_nothing(self):
        for command in ("map", "evaluate"):
            with self.subTest(command):
                self.browser.get_log("browser")
                self.open(command)
                self.assertEqual(self.browser.get_log("browser"), [])
                loaded = self.browser.execute_script(
                    "return performance.getEntriesByType('resource').map((entry) => entry.name)"
                    ".filter((name) => !name.startsWith('data:'))")
                self.assertEqual(loaded, [])

    def test_fits_a_laptop_and_a_narrow_window(self):
        for width in (1366, 800):
            with self.subTest(width):
                self.browser.set_window_size(width, 900)
                self.open("evaluate")
                self.assertLessEqual(
                    self.browser.execute_script("return document.documentElement.scrollWidth"),
                    width)
        self.browser.set_window_size(1366, 900)

    def test_steps_through_the_frames(self):
        self.open("map")
        self.assertEqual(self.shown_frames(), [0])
        self.click(".strip .next")
        self.assertEqual(self.shown_frames(), [1])
        strip = self.browser.find_element(By.CSS_SELECTOR, ".strip")
        strip.send_keys(Keys.ARROW_RIGHT)
        self.assertEqual(self.shown_frames(), [2])
        strip.send_keys(Keys.ARROW_RIGHT)
        self.assertEqual(self.shown_frames(), [2], "it ends there")
        self.click(".strip .previous")
        self.assertEqual(self.shown_frames(), [1])
        slider = self.browser.find_element(By.CSS_SELECTOR, ".strip input")
        slider.send_keys(Keys.ARROW_LEFT)
        self.assertEqual(self.shown_frames(), [0], "one step, not two")

    def test_shows_all_frames_and_no_controls_without_scripts(self):
        text = (self.out / "map" / "report.html").read_text(encoding="utf-8")
        bare = self.out / "bare.html"
        bare.write_text(re.sub(r"<script>.*?</script>", "", text, flags=re.DOTALL), encoding="utf-8")
        self.browser.get(bare.as_uri())
        self.assertEqual(self.shown_frames(), [0, 1, 2])
        for control in self.browser.find_elements(By.CSS_SELECTOR, ".controls"):
            self.assertFalse(control.is_displayed())
        self.assertIn("needs scripts", self.browser.find_element(By.CSS_SELECTOR, ".canvas").text)

    def test_turns_the_map(self):
        self.open("map")
        at_first = self.picture()
        canvas = self.browser.find_element(By.CSS_SELECTOR, ".scene canvas")
        ActionChains(self.browser).drag_and_drop_by_offset(canvas, 220, -60).perform()
        turned = self.picture()
        self.assertGreater(difference(at_first, turned), 5, "dragging turns it")
        self.click("[data-view=corner]")
        self.assertLess(difference(at_first, self.picture()), 0.5, "and the button brings it back")
        self.click("[data-view=above]")
        self.assertGreater(difference(at_first, self.picture()), 5)

    def test_shows_the_map_with_and_without_unwrapping(self):
        self.open("map")
        at_first = self.picture()
        self.click(".scene input[name^=cloud][value='1']")
        self.assertGreater(difference(at_first, self.picture()), 2)
        self.click(".scene input[name^=coloring][value='1']")
        legends = self.browser.find_elements(By.CSS_SELECTOR, ".scene .legend")
        self.assertEqual([legend.is_displayed() for legend in legends], [False, True])

    def test_draws_the_map_as_expected(self):
        self.open("map")
        picture = self.picture()
        if WRITES_EXPECTED:
            picture.convert("RGB").resize((344, 216), Image.BOX).save(EXPECTED)
        # Renderers differ in where a point's edge lies; a wrong map or view differs by 10 and more.
        self.assertLess(difference(picture, Image.open(EXPECTED)), 3)

    def test_prints_every_frame(self):
        self.open("map")
        self.browser.execute_cdp_cmd("Emulation.setEmulatedMedia", {"media": "print"})
        self.addCleanup(self.browser.execute_cdp_cmd, "Emulation.setEmulatedMedia", {"media": ""})
        self.assertEqual(self.shown_frames(), [0, 1, 2])
        self.assertFalse(self.browser.find_element(By.CSS_SELECTOR, ".strip .next").is_displayed())
        printed = base64.b64decode(self.browser.print_page())
        self.assertTrue(printed.startswith(b"%PDF"))
        fits = self.browser.execute_script(
            "return document.querySelector('.scene canvas').getBoundingClientRect().width"
            " <= document.querySelector('main').getBoundingClientRect().width")
        self.assertTrue(fits, "the map is not cut off")
        if "TOFMAP_KEEP_PRINT" in os.environ:  # to look at it
            pathlib.Path(os.environ["TOFMAP_KEEP_PRINT"]).write_bytes(printed)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1], verbosity=2)
