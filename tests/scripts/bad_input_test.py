"""What no command of scripts/ does with input that is wrong or output that cannot be written: a traceback, several lines, a
wrong exit code, or any change to the files. Every command stands in command_table.py, with every option."""
import concurrent.futures
import contextlib
import json
import os
import pathlib
import re
import resource
import subprocess
import sys
import tempfile
import unittest

from command_table import BAD, COMMANDS, NEAR
from stand_in_sweep import write_index
from synthetic import SCRIPTS, command_files, write_matrix, write_steps

# Answers what it would be known by, refuses what is called nope, and leaves a file where it is run.
PROGRAM = """#!/bin/sh
case "$*" in
  sweep*) { grep -q '^partitioner.*nope' "$2" && echo "cleave sweep: x.toml:1: partitioner: 'nope' is unknown" >&2; } ||
          { grep -q '^solver.*nope' "$2" && echo "cleave sweep: x.toml:1: solver: 'nope' is unknown" >&2; } || touch ran
          exit 1 ;;
  *"--solver nope"*) echo "cleave run: --solver: 'nope' is unknown" >&2; exit 1 ;;
  *nope*) echo "cleave run: --partitioner: 'nope' is unknown" >&2; exit 1 ;;
  *--print-key*) echo '{"run_id": "1", "threads": 1, "git_hash": "f", "git_dirty": "false", "compiler": "GCC",
    "flags": "-march=x86-64-v3", "build_type": "RelWithDebInfo", "cpu_model": "C", "cores": 2}'; exit 0 ;;
esac
touch ran
exit 1
"""
GARBAGE = {"text": b"no such thing\n1,2\n", "bytes": bytes(range(128, 256)), "nothing": b"", "a header": b"x\n",
           "a value": b"scene,step,status\nrock_pile,many,ok\n"}
IN_SHELL = ("setup", "test")


def files_of(directory):
    """{path: what is there}"""
    return {str(path): path.read_bytes() if path.is_file() else None for path in pathlib.Path(directory).rglob("*")}


class Scratch:
    """A directory for one command, with what its words mean."""

    def __init__(self, directory):
        self.root = pathlib.Path(directory)
        self.names = {name: self.root / name for name in ("tree", "extremes", "empty", "file", "out")}
        write_matrix(self.names["tree"])
        write_steps(self.names["extremes"] / "cells" / "a", [{"status": "ok", "factorizations": 5}])
        write_index(self.names["extremes"], [{"cell": "a", "label": "ratio_1_x_cfm_0_seed_1"}])
        self.names["empty"].mkdir()
        self.names["file"].write_text("no directory")
        self.program = self.root / "cleave"
        self.program.write_text(PROGRAM)
        self.program.chmod(0o755)

    def words(self, words):
        return [word.format(**self.names) for word in words]

    def run(self, command, *words, **options):
        return self.run_program([SCRIPTS / command, *self.words(words)], **options)

    def run_program(self, words, **options):
        environment = dict(os.environ, CLEAVE_PROGRAM=str(self.program)) | options.pop("env", {})
        options = {"input": b"", "stdout": subprocess.PIPE, "timeout": 300, **options}
        return subprocess.run(words, cwd=self.names["empty"], env=environment, stderr=subprocess.PIPE, check=False, **options)

    def run_one_after_another(self, command, many):
        """The ends of the command with many words each, in one process where it is Python."""
        if not many or command in IN_SHELL:
            return [self.run(command, *words) for words in many]
        program = [sys.executable, pathlib.Path(__file__).parent / "one_after_another.py", SCRIPTS / command]
        result = self.run_program(program, input=json.dumps([self.words(words) for words in many]).encode())
        assert result.returncode == 0, result.stderr
        return [subprocess.CompletedProcess(words, code, stderr=said.encode())
                for words, (code, said) in zip(many, json.loads(result.stdout.splitlines()[-1]), strict=True)]


def fault(scratch, before, result, code=1, words=()):
    """What is wrong with the end of a command that was given bad input; None where nothing is."""
    said = result.stderr.decode(errors="replace")
    if "Traceback" in said or result.returncode != code:
        return f"exit code {result.returncode}: {said}"
    if len(said.splitlines()) != (code == 1):
        return f"not one line: {said}"
    missing = [word for word in words if word not in said]
    if missing:
        return f"does not say {missing}: {said}"
    return None if files_of(scratch.root) == before else "files have changed"


def bad_values(command):
    """(words, what has to be said) of every option and value that is wrong."""
    for option, kind in COMMANDS[command].options.items():
        if kind:
            yield (option,), (option, "needs a")
        for value in BAD[kind]:
            yield (f"{option}={value}",) if command not in IN_SHELL else (option, value), (
                option.lstrip("-"), *([NEAR[value]] if value in NEAR else []))
    if not COMMANDS[command].passes_on:
        yield ("--no-such-option",), ("--no-such-option",)
    if "--out" in COMMANDS[command].options:
        yield ("--uot", "x"), ("did you mean --out?",)


def words_for(command, wrong):
    """With what the command cannot do without, unless that is what is wrong."""
    given = COMMANDS[command].given
    return (*given, *wrong) if wrong[0].partition("=")[0] not in given else wrong


def faults_of_values(command):
    """One line a value that is not refused as it has to be."""
    values = list(bad_values(command))
    with tempfile.TemporaryDirectory() as directory:
        scratch = Scratch(directory)
        before = files_of(scratch.root)
        ends = scratch.run_one_after_another(command, [words_for(command, words) for words, _ in values])
        faults = {words: fault(scratch, before, end, words=told) for (words, told), end in zip(values, ends)}
    return [f"{command} {' '.join(words)[:100]}: {wrong}" for words, wrong in faults.items() if wrong]


class TableTest(unittest.TestCase):

    def test_every_command_stands_in_the_table(self):
        self.assertEqual({str(path.relative_to(SCRIPTS)) for path in command_files()}, set(COMMANDS))

    def test_every_option_stands_in_the_table(self):
        for name, command in COMMANDS.items():
            text = subprocess.run([SCRIPTS / name, "--help"], capture_output=True, text=True, check=True).stdout
            self.assertEqual(set(re.findall(r"^  (?:-h, )?(--[\w-]+)", text, re.M)) - {"--help"}, set(command.options), name)


class BadInputTest(unittest.TestCase):

    def setUp(self):
        directory = tempfile.TemporaryDirectory()
        self.addCleanup(directory.cleanup)
        self.scratch = Scratch(directory.name)
        self.before = files_of(self.scratch.root)

    def check(self, result, code=1, words=()):
        self.assertIsNone(fault(self.scratch, self.before, result, code, words))

    def test_every_bad_value_of_every_option(self):
        with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
            found = [line for lines in pool.map(faults_of_values, COMMANDS) for line in lines]
        self.assertEqual(found, [], "\n".join(found))

    def test_a_program_that_cannot_be_run(self):
        for name, command in COMMANDS.items():
            if command.runs and name != "reference":  # which looks at the checkout first
                with self.subTest(name):
                    result = self.scratch.run(name, *command.given, "--out", "{out}", env={"CLEAVE_PROGRAM": "/nowhere"})
                    self.check(result, words=["CLEAVE_PROGRAM is '/nowhere', which cannot be run"])

    def test_output_that_nobody_takes(self):
        for name, command in COMMANDS.items():
            for words in (("--help",), command.prints):
                if words:
                    with self.subTest(name, words=words):
                        with open("/dev/full", "wb") as full:
                            self.check(self.scratch.run(name, *words, stdout=full), words=["No space left on device"])
                        with self.closed_pipe() as pipe:
                            self.check(self.scratch.run(name, *words, stdout=pipe), code=141)

    @contextlib.contextmanager
    def closed_pipe(self):
        reader, writer = os.pipe()
        os.close(reader)
        try:
            yield writer
        finally:
            os.close(writer)

    def check_one_after_another(self, name, many):
        for words, end in zip(many, self.scratch.run_one_after_another(name, many), strict=True):
            with self.subTest(name, words=words):
                self.check(end)

    def test_directories_that_are_not_there_or_hold_nothing(self):
        for name, command in COMMANDS.items():
            # Some read files too.
            file = "{out}" if name in ("table1", "check_matrix", "validate_model", "extremes_table") else "{file}"
            self.check_one_after_another(name, [[value if word == place else word for word in command.given]
                                                for place in command.reads for value in ("", file, "{out}/nowhere", "{empty}")])

    def test_files_that_hold_something_else(self):
        directories = {}
        for file in ("steps.csv", "motion.h5"):
            for what, content in GARBAGE.items():
                directories[file, what] = self.scratch.root / f"{file} {what}"
                directories[file, what].mkdir()
                (directories[file, what] / file).write_bytes(content)
        self.before = files_of(self.scratch.root)
        for name, command in COMMANDS.items():
            self.check_one_after_another(name, [[str(directory) if word in command.reads else word for word in command.given]
                                                for (_, what), directory in directories.items()
                                                if command.reads and (what, name) != ("a header", "readme_tables")])

    def test_results_beside_their_input_have_a_place_that_can_be_written(self):
        tree = self.scratch.names["tree"]
        (tree / "figures").write_text("no directory")
        (tree / "viewer.html").mkdir()
        self.before = files_of(self.scratch.root)
        for name in ("report", "render_figures"):
            self.check(self.scratch.run(name, "{tree}"), words=["figures"])
        self.check(self.scratch.run("view", "{tree}"), words=["viewer.html"])

    def test_a_file_that_cannot_be_written_whole_stays_as_it_was(self):
        def no_room():
            resource.setrlimit(resource.RLIMIT_FSIZE, (10, 10))

        (self.scratch.root / "file.csv").write_text("old")
        self.before = files_of(self.scratch.root)
        result = self.scratch.run("extremes_table", "{extremes}", "--csv", str(self.scratch.root / "file.csv"),
                                  preexec_fn=no_room)
        self.check(result, words=["file.csv: cannot be written: File too large"])


if __name__ == "__main__":
    unittest.main()
