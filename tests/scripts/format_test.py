"""C++ is as clang-format writes it (.clang-format), and comments, which it leaves alone, keep within the same columns."""
import pathlib
import re
import subprocess
import tempfile
import unittest

from synthetic import SCRIPTS

ROOT = SCRIPTS.parent
STYLE = ROOT / ".clang-format"
ROOMS = ("harness", "partition", "scenarios", "solver", "tests")


def columns():
    return int(re.search(r"^ColumnLimit: (\d+)$", STYLE.read_text(), re.M).group(1))


def sources():
    return sorted(file for room in ROOMS for end in ("*.h", "*.cpp") for file in (ROOT / room).rglob(end))


def unformatted(files):
    """What clang-format would change, a line each: FILE:LINE:COLUMN: ..."""
    run = subprocess.run(["clang-format", f"--style=file:{STYLE}", "--dry-run", *files], text=True, capture_output=True, check=True)
    return [line for line in run.stderr.splitlines() if "warning:" in line]


def too_long(files):
    return [f"{file}:{number}" for file in files for number, line in enumerate(file.read_text().splitlines(), 1)
            if len(line) > columns()]


class FormatTest(unittest.TestCase):

    def test_every_source(self):
        self.assertGreater(len(sources()), 500)
        self.assertEqual(unformatted(sources()), [])
        self.assertEqual(too_long(sources()), [])

    def test_what_is_not_formatted_is_found(self):
        with tempfile.TemporaryDirectory() as directory:
            file = pathlib.Path(directory) / "wide.cpp"
            file.write_text("int  main() { return 0; }\n// " + "x" * columns() + "\n")
            self.assertEqual(len(unformatted([file])), 1)
            self.assertEqual(too_long([file]), [f"{file}:2"])


if __name__ == "__main__":
    unittest.main()
