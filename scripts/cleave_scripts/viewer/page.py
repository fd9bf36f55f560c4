"""The viewer: an HTML fragment that replays recorded runs in WebGL, with no file or network beside it.

    viewer_section(directory)   the fragment, or a note where no motion was recorded
    viewer_page(directory)      a page of its own

The sources of the page are in web/. `npm ci` brings three.js and the bundler esbuild, in the
versions of package-lock.json, when they are not there yet.
"""
import fcntl
import html
import pathlib
import string
import subprocess
import tempfile

import numpy

from cleave_scripts.motion.recording import load_motions
from cleave_scripts.results.errors import ResultError
from cleave_scripts.viewer.packing import pack

SOURCES = pathlib.Path(__file__).resolve().parent / "web"
PAGE_BYTES = 30e6  # recordings are thinned to about this much
NO_MOTION = ("<p class=\"cleave-message\">No motion recorded: there is no motion.h5. "
             "<code>cleave run --record-motion</code> writes one.</p>\n")


def viewer_section(directory, autofocus=False, page_bytes=PAGE_BYTES):
    """All recordings in a directory or below, one at a time."""
    motions = load_motions(directory)
    if not motions:
        return NO_MOTION
    recordings = "\n".join(_recording_script(motion, page_bytes / len(motions)) for motion in motions)
    template = string.Template((SOURCES / "viewer.html").read_text(encoding="utf-8"))
    return template.substitute(css=(SOURCES / "viewer.css").read_text(encoding="utf-8"),
                               autofocus=" autofocus" if autofocus else "",
                               recordings=recordings,
                               script=build_script())


def viewer_page(directory, **options):
    section = viewer_section(directory, autofocus=True, **options)
    return ("<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
            "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
            "<title>cleave: recorded motion</title>\n"
            f"<link rel=\"icon\" href=\"data:,\">\n</head>\n<body>\n{section}</body>\n</html>\n")


def build_script():
    """The page's program with three.js in it, as text that may stand in a script element."""
    _install_packages()
    with tempfile.TemporaryDirectory() as directory:
        bundle = pathlib.Path(directory) / "viewer.js"
        _run([
            "node_modules/.bin/esbuild", "source/main.js", "--bundle", "--minify", "--format=iife",
            "--target=es2022", "--log-level=error", f"--outfile={bundle}"
        ], "bundling the viewer")
        return bundle.read_text(encoding="utf-8")


def _install_packages():
    """One process at a time: `npm ci` begins by removing what another one has installed so far."""
    installed = SOURCES / "node_modules" / ".package-lock.json"  # npm writes it last
    if installed.exists():
        return
    with (SOURCES / "package.json").open("r+b") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        if not installed.exists():
            _run(["npm", "ci", "--silent"], "installing three.js and esbuild from npm")


def _run(command, what):
    try:
        result = subprocess.run(command, cwd=SOURCES, capture_output=True, text=True, check=False)
    except FileNotFoundError:
        raise ResultError(f"{what}: {command[0]} is not installed; scripts/setup installs it") from None
    if result.returncode != 0:
        text = (result.stderr or result.stdout).strip().splitlines() or ["no message"]
        raise ResultError(f"{what} failed: {text[0]}")


def _recording_script(motion, most_bytes):
    """Thins until it fits: every k-th measured step, and every k-th step besides."""
    stride, script = 1, pack(motion, 1)
    while len(script) > most_bytes and stride < len(motion.step):
        stride = max(stride + 1, int(numpy.ceil(stride * len(script) / most_bytes)))
        script = pack(motion, stride)
    name = html.escape(_recording_name(motion))
    return f'<script type="application/json" class="cleave-recording" data-name="{name}">{script}</script>'


def _recording_name(motion):
    text = f"{motion.scene}, {motion.bodies} bodies, seed {motion.attributes['seed']}"
    return text if motion.name == motion.scene else f"{motion.name}: {text}"
