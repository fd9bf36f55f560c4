"""C++ is as clang-format writes it (.clang-format), and comments, which it leaves alone, keep within the same columns; Python
keeps within columns of its own."""
import pathlib
import re
import subprocess
import tempfile
import unittest

from synthetic import SCRIPTS

ROOT = SCRIPTS.parent
STYLE = ROOT / ".clang-format"
PYTHON_COLUMNS = 128
ROOMS = ("harness", "partition", "scenarios", "solver", "tests")


def columns():
    return int(re.search(r"^ColumnLimit: (\d+)$", STYLE.read_text(), re.M).group(1))


def sources():
    return sorted(file for room in ROOMS for end in ("*.h", "*.cpp") for file in (ROOT / room).rglob(end))


def python_sources():
    """Modules, and scripts that name no ending."""
    files = (file for room in ("scripts", *ROOMS) for file in (ROOT / room).rglob("*") if file.is_file())
    return sorted(file for file in files if file.suffix == ".py" or not file.suffix and begins_as_python(file))


def begins_as_python(file):
    with open(file, "rb") as opened:
        return b"python" in opened.readline(80)


def unformatted(files):
    """What clang-format would change, a line each: FILE:LINE:COLUMN: ..."""
    run = subprocess.run(["clang-format", f"--style=file:{STYLE}", "--dry-run", *files], text=True,
                         capture_output=True, check=True)
    return [line for line in run.stderr.splitlines() if "warning:" in line]


def too_long(files, most):
    return [f"{file}:{number}" for file in files for number, line in enumerate(file.read_text().splitlines(), 1)
            if len(line) > most]


class FormatTest(unittest.TestCase):

    def test_every_source(self):
        self.assertGreater(len(sources()), 500)
        self.assertEqual(unformatted(sources()), [])
        self.assertEqual(too_long(sources(), columns()), [])

    def test_every_python_source(self):
        self.assertGreater(len(python_sources()), 200)
        self.assertIn(SCRIPTS / "two_threads", python_sources())
        self.assertEqual(too_long(python_sources(), PYTHON_COLUMNS), [])

    def test_what_is_not_formatted_is_found(self):
        with tempfile.TemporaryDirectory() as directory:
            file = pathlib.Path(directory) / "wide.cpp"
            file.write_text("int  main() { return 0; }\n// " + "x" * columns() + "\n")
            self.assertEqual(len(unformatted([file])), 1)
            self.assertEqual(too_long([file], columns()), [f"{file}:2"])


if __name__ == "__main__":
    unittest.main()
