"""Sources that are compiled as one keep no name to themselves that another of them,
or its headers, has too."""
import pathlib
import subprocess
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
OWN = "namespace cleave {{\nnamespace {{\n{}\n}}  // namespace\n}}  // namespace cleave\n"


def units_of(root, size=8):
    """{source: unit}"""
    text = subprocess.run([sys.executable, str(ROOT / "tests/units.py"), str(root), str(size)],
                          capture_output=True, text=True, check=True).stdout
    lines = [line.split() for line in text.splitlines()]
    return dict(lines), [source for source, _ in lines]


class OfAPlantedProject(unittest.TestCase):
    def setUp(self):
        directory = tempfile.TemporaryDirectory()
        self.addCleanup(directory.cleanup)
        self.root = pathlib.Path(directory.name)

    def write(self, name, text):
        path = self.root / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)

    def units(self, *sources, size=8):
        units, _ = units_of(self.root, size)
        return [units[source] for source in sources]

    def assert_apart(self, first, second):
        self.write("solver/a.cpp", first)
        self.write("solver/b.cpp", second)
        a, b = self.units("solver/a.cpp", "solver/b.cpp")
        self.assertNotEqual(a, b)

    def test_sources_without_a_common_name_are_one_unit_as_far_as_they_find_room(self):
        for k in range(5):
            self.write(f"solver/s{k}.cpp", OWN.format(f"constexpr int k{k} = 1;"))
        units = self.units(*(f"solver/s{k}.cpp" for k in range(5)), size=2)
        self.assertEqual([units.count(unit) for unit in units], [2, 2, 2, 2, 1])

    def test_every_kind_of_declaration_keeps_two_sources_apart(self):
        for line in ["constexpr int kMost = 3;", "const std::vector<int> kMost = {1};", "double kMost{2};", "class kMost {",
                     "struct kMost {", "enum class kMost { one };", "using kMost = int;", "int kMost(int a) { return a; }",
                     "std::vector<std::string> kMost() {", "constexpr double other = 1, kMost = 2;", "int kMost[4] = {};"]:
            with self.subTest(line):
                self.assert_apart(OWN.format(line), OWN.format("struct kMost;\nstruct kMost {};"))

    def test_a_name_that_one_keeps_and_the_other_shows_keeps_them_apart(self):
        self.assert_apart(OWN.format("int count();"), "namespace cleave {\nint count() { return 1; }\n}  // namespace cleave\n")
        self.assert_apart("namespace cleave {\nint count() { return 1; }\n}  // namespace cleave\n", OWN.format("int count();"))

    def test_a_name_of_a_header_counts_where_the_other_source_includes_it(self):
        self.write("solver/far.h", "namespace cleave {\nstruct Row {};\n}  // namespace cleave\n")
        self.write("solver/near.h", '#include "solver/far.h"\n')
        self.assert_apart(OWN.format("struct Row;"), '#include "solver/near.h"\n')
        self.assert_apart('#include "solver/near.h"\n', OWN.format("struct Row;"))
        self.write("solver/b.cpp", "")
        self.write("solver/a.cpp", OWN.format("struct Row;"))
        self.assertEqual(*self.units("solver/a.cpp", "solver/b.cpp"))

    def test_a_folder_without_sources_is_an_error(self):
        with self.assertRaises(subprocess.CalledProcessError) as failed:
            units_of(self.root)
        self.assertEqual(failed.exception.stderr, f"units.py: no sources in '{self.root}'\n")

    def test_rooms_are_apart(self):
        for name in ("solver/a.cpp", "partition/a.cpp", "harness/files/a.cpp", "harness/world/a.cpp", "tests/solver/a.cpp"):
            self.write(name, "")
        units, _ = units_of(self.root)
        self.assertEqual(len(set(units.values())), 5)


class OfThisProject(unittest.TestCase):
    def test_every_source_has_one_unit_and_most_share_theirs(self):
        units, sources = units_of(ROOT)
        there = {path.relative_to(ROOT).as_posix() for folder in ("harness", "solver", "partition", "scenarios", "tests")
                 for path in (ROOT / folder).rglob("*.cpp")}
        self.assertEqual(sorted(sources), sorted(there))
        self.assertLess(len(set(units.values())), len(sources) / 3)


if __name__ == "__main__":
    unittest.main()
