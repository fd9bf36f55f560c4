#!/usr/bin/python3
"""How long the viewer takes to open a recorded run, and how many pictures a second it draws while it plays.

    tests/benchmarks/viewer_benchmark.py DIR [--width 800] [--height 600] [--seconds 5]

DIR holds motion.h5. Headless Chromium without a graphics card. The aim is 3 s and 30 a second for 500 steps
of 600 bodies:

    build/release/cleave run --scene large_rock_pile --steps 500 --measure-every 10 --record-motion --out DIR
"""
import argparse
import os
import pathlib
import sys
import tempfile
import time

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT / "scripts"), str(ROOT / "tests" / "scripts")]

from browser import Browser  # noqa: E402
from cleave_scripts.motion.recording import load_motions  # noqa: E402
from cleave_scripts.viewer.page import viewer_page  # noqa: E402

VIEWER = "document.querySelector('.cleave-viewer').cleaveViewer"


def frames_per_second(browser, seconds):
    """While it plays at the speed at which it happened, from a quarter of the run on, and with how many pixels."""
    browser.value(f"{VIEWER}.seek({VIEWER}.recording.steps >> 2), {VIEWER}.toggle()")
    time.sleep(0.5)
    before, start = browser.value(f"{VIEWER}.framesDrawn"), time.monotonic()
    while time.monotonic() < start + seconds:
        time.sleep(0.5)
        browser.value(f"{VIEWER}.playing || {VIEWER}.toggle()")
    drawn = browser.value(f"{VIEWER}.framesDrawn") - before
    rate, size = drawn / (time.monotonic() - start), canvas_size(browser)
    browser.value(f"{VIEWER}.pause()")
    return f"{rate:.0f} frames/s at {size[0]} x {size[1]}"


def canvas_size(browser):
    return browser.value(f"[{VIEWER}.ui.canvas.width, {VIEWER}.ui.canvas.height]")


def measure(page, options):
    with Browser(options.width, options.height) as browser:
        start = time.monotonic()
        browser.open(page)
        browser.wait_for("document.querySelector('.cleave-viewer')?.cleaveViewer?.framesDrawn > 0")
        opened_s = time.monotonic() - start
        canvas = canvas_size(browser)
        with_graph = frames_per_second(browser, options.seconds)
        browser.value(f"{VIEWER}.ui.graph.click()")
        return opened_s, canvas, with_graph, frames_per_second(browser, options.seconds)


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("directory", metavar="DIR", type=pathlib.Path)
    parser.add_argument("--width", type=int, default=800)
    parser.add_argument("--height", type=int, default=600)
    parser.add_argument("--seconds", type=float, default=5)
    options = parser.parse_args()
    motion = load_motions(options.directory)[0]
    with tempfile.TemporaryDirectory() as directory:
        page = pathlib.Path(directory) / "page.html"
        start = time.monotonic()
        page.write_text(viewer_page(options.directory), encoding="utf-8")
        made_s = time.monotonic() - start
        size_mb = page.stat().st_size / 1e6
        opened_s, canvas, with_graph, without = measure(page, options)
    print(f"{len(motion.step)} steps x {motion.bodies} bodies, {len(motion.measured.step)} measured steps, "
          f"{len(motion.combinations)} combinations, window {options.width} x {options.height}, canvas "
          f"{canvas[0]} x {canvas[1]}")
    print(f"page {size_mb:.1f} MB, made in {made_s:.1f} s, opened in {opened_s:.1f} s (aim 3)")
    print(f"{with_graph} with the graph, {without} without (aim 30); load average {os.getloadavg()[0]:.1f}")


if __name__ == "__main__":
    main()
