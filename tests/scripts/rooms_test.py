"""The rooms of scripts/cleave_scripts: each imports from itself and from rooms above it in the list of its README."""
import ast
import pathlib
import re
import tempfile
import unittest

from synthetic import SCRIPTS

PACKAGE = SCRIPTS / "cleave_scripts"


def listed_rooms():
    return re.findall(r"^\| `(\w+)` \|", (PACKAGE / "README.md").read_text(), re.M)


def imports(file):
    """(line, imported module) of a file, also of imports inside functions."""
    for node in ast.walk(ast.parse(file.read_text())):
        if isinstance(node, ast.ImportFrom):
            yield from ((node.lineno, f"{node.module}.{alias.name}") for alias in node.names)
        elif isinstance(node, ast.Import):
            yield from ((node.lineno, alias.name) for alias in node.names)


def wrong_imports(package, rooms):
    """One line an import that does not lead from a room to itself or to one above it."""
    for file in sorted(package.rglob("*.py")):
        room = file.relative_to(package).parts[0]
        allowed = rooms[:rooms.index(room) + 1] if room in rooms else []
        for line, module in imports(file):
            first, *rest = module.split(".")
            if first == "None" or first in rooms or first == package.name and (not rest or rest[0] not in allowed):
                yield f"{file.relative_to(package)}, line {line}: {module}"


class RoomsTest(unittest.TestCase):

    def test_the_list_names_every_room_and_no_other(self):
        there = {file.parent.name for file in PACKAGE.glob("*/__init__.py")}
        self.assertEqual(len(listed_rooms()), len(set(listed_rooms())))
        self.assertEqual(set(listed_rooms()), there)
        self.assertEqual([file.name for file in PACKAGE.glob("*.py")], ["__init__.py"])

    def test_arrows_lead_to_rooms_above(self):
        self.assertEqual(list(wrong_imports(PACKAGE, listed_rooms())), [])

    def test_an_arrow_that_leads_elsewhere_is_found(self):
        first, last = listed_rooms()[0], listed_rooms()[-1]
        for text in (f"from cleave_scripts.{last} import x", f"from cleave_scripts.{last}.x import y",
                     f"import cleave_scripts.{last}", f"def f():\n    from cleave_scripts.{last} import x",
                     f"from cleave_scripts import {last}", f"import {last}", "from . import x"):
            with tempfile.TemporaryDirectory() as directory:
                file = pathlib.Path(directory) / "cleave_scripts" / first / "module.py"
                file.parent.mkdir(parents=True)
                file.write_text(text + "\n")
                self.assertEqual(len(list(wrong_imports(file.parents[1], listed_rooms()))), 1, text)

    def test_no_module_stands_among_the_commands(self):
        self.assertEqual([file.name for file in SCRIPTS.iterdir() if file.suffix], [])


if __name__ == "__main__":
    unittest.main()
