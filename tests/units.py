#!/usr/bin/python3
"""Which sources are compiled as one (units.cmake).

usage: units.py ROOT SIZE

Prints, one a line, the sources of the project in ROOT, each with the unit that it belongs to: at most SIZE sources of a room,
of which none declares a name between "namespace {" and its end that another of them, or a header that one of them includes,
declares too. What is looked at is the first column, where this project's formatting puts every declaration of a namespace;
overloads of a function count as one name.
"""
import argparse
import pathlib
import re
import sys

FOLDERS = ["harness", "solver", "partition", "scenarios", "tests"]
TYPE = re.compile(r"(?:class|struct|enum class|enum|union|using) (\w+)")
CONSTANTS = re.compile(r"(\w+)(?:\[\w*\])? = |(\w+)\{")
FUNCTION = re.compile(r"[\w:<>,&*\[\]\s]*?[\s&*](\w+)\(")
INCLUDE = re.compile(r'#include "(.+)"', re.MULTILINE)
NO_NAME = re.compile(r"[\s}#/]|namespace|TEST|INSTANTIATE|template|using namespace|using [\w:]+;|$")


def declared(line):
    """Names that a line in the first column declares."""
    if NO_NAME.match(line):
        return set()
    kind = TYPE.match(line)
    if kind:
        return {kind[1]}
    function = FUNCTION.match(line)
    if function:
        return {function[1]}
    return {name for pair in CONSTANTS.findall(line) for name in pair if name}


def names_of(text):
    """(names kept to the file, all names): of namespaces, as far as they are declared in the first column."""
    own, every, inside = set(), set(), False
    for line in text.splitlines():
        if line.startswith("namespace {"):
            inside = True
        elif line.startswith("}  // namespace"):
            inside = False
        names = declared(line)
        every |= names
        own |= names if inside else set()
    return own, every


class Project:
    def __init__(self, root):
        paths = [path for folder in FOLDERS for path in sorted((root / folder).rglob("*")) if path.suffix in (".cpp", ".h")]
        texts = {path.relative_to(root).as_posix(): path.read_text() for path in paths}
        self.sources = [file for file in texts if file.endswith(".cpp")]
        names = {file: names_of(text) for file, text in texts.items()}
        self.own = {file: own for file, (own, _) in names.items()}
        self.every = {file: every for file, (_, every) in names.items()}
        self.includes = {file: [name for name in INCLUDE.findall(text) if name in texts] for file, text in texts.items()}

    def seen_names(self, file):
        """Names of a file and of all that it includes."""
        names, waiting, met = set(), [file], set()
        while waiting:
            at = waiting.pop()
            if at not in met:
                met.add(at)
                names |= self.every[at]
                waiting += self.includes[at]
        return names


class Unit:
    def __init__(self, name):
        self.name, self.files, self.own, self.seen = name, 0, set(), set()

    def has_room_for(self, own, seen, size):
        return self.files < size and not (own & self.seen or seen & self.own)

    def add(self, own, seen):
        self.files += 1
        self.own |= own
        self.seen |= seen


def room_of(file):
    """Sources of one library or test program: a folder of harness or of tests, or one of the other folders."""
    parts = file.split("/")
    return "_".join(parts[:2] if parts[0] in ("harness", "tests") else parts[:1])


def main(root, size):
    project, units_of_room = Project(root), {}
    if not project.sources:
        sys.exit(f"units.py: no sources in '{root}'")
    for file in project.sources:
        units = units_of_room.setdefault(room_of(file), [])
        own, seen = project.own[file], project.seen_names(file)
        unit = next((unit for unit in units if unit.has_room_for(own, seen, size)), None)
        if unit is None:
            unit = Unit(f"{room_of(file)}_{len(units)}")
            units.append(unit)
        unit.add(own, seen)
        print(f"{file} {unit.name}")


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description="See the head of this file.")
    parser.add_argument("root", metavar="ROOT", type=pathlib.Path)
    parser.add_argument("size", metavar="SIZE", type=int)
    given = parser.parse_args()
    main(given.root, given.size)
