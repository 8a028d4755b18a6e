// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

// Shows the frames of a strip one at a time. Without this script, all frames are visible.
document.querySelectorAll(".strip").forEach((strip) => {
  const frames = [...strip.querySelectorAll(".frame")];
  const slider = strip.querySelector("input[type=range]");
  const place = strip.querySelector("output");
  let shown = 0;

  const show = (index) => {
    shown = Math.max(0, Math.min(frames.length - 1, index));
    frames.forEach((frame, i) => frame.classList.toggle("shown", i === shown));
    slider.value = shown;
    place.textContent = `${shown + 1} of ${frames.length}`;
  };

  strip.querySelector(".previous").addEventListener("click", () => show(shown - 1));
  strip.querySelector(".next").addEventListener("click", () => show(shown + 1));
  slider.addEventListener("input", () => show(Number(slider.value)));
  strip.addEventListener("keydown", (event) => {
    const steps = { ArrowLeft: -1, ArrowRight: 1 };
    if (!(event.key in steps) || event.altKey || event.ctrlKey || event.metaKey) return;
    event.preventDefault();  // the slider would step as well
    show(shown + steps[event.key]);
  });
  strip.classList.add("stepped");
  strip.querySelector(".controls").hidden = false;
  show(0);
});
