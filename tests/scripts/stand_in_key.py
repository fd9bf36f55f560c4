"""What a stand-in for the program is known by; STAND_IN_KEY in the environment changes parts of it."""
import hashlib
import json
import os
import sys

LEFT_OUT = ("--force", "--print-key")


def _words(argv):
    """The options that the run id is made of."""
    places = [place for place, word in enumerate(argv) if word in ("--out", "--threads")]
    skipped = {place + offset for place in places for offset in (0, 1)}
    return [word for place, word in enumerate(argv) if place not in skipped and word not in LEFT_OUT]


def key(argv):
    changes = json.loads(os.environ.get("STAND_IN_KEY", "{}"))
    text = " ".join(_words(argv[1:]))
    threads = int(argv[argv.index("--threads") + 1]) if "--threads" in argv else 1
    return {
        "run_id": hashlib.sha256(text.encode()).hexdigest()[:16],
        "threads": threads,
        "git_hash": "0123456789abcdef0123456789abcdef01234567",
        "git_dirty": "false",
        "compiler": "GCC 12.2.0",
        "flags": "-O3 -march=x86-64-v3",
        "build_type": "RelWithDebInfo",
        "cpu_model": "Some CPU",
        "cores": 2,
        **changes
    }


def answer(argv=None):
    """Prints the key and ends where it is asked for."""
    argv = argv or sys.argv
    if "--print-key" in argv:
        print(json.dumps(key(argv)))
        sys.exit(0)


def manifest_entries(argv=None):
    """The entries of a manifest that hold the key."""
    parts = key(argv or sys.argv)
    return {
        "run_id": parts["run_id"],
        "options": {"threads": parts["threads"]},
        "build": {name: parts[name] for name in ("git_hash", "git_dirty", "compiler", "flags", "build_type")},
        "machine": {name: parts[name] for name in ("cpu_model", "cores")},
    }
