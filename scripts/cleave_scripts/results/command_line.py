"""The one reader of command lines in scripts/: what is wrong is one line that names the option, the value and what is
allowed, and exit code 1, before anything is written or made."""
import argparse
import pathlib
import re

from cleave_scripts.results.errors import ResultError
from cleave_scripts.results.names import nearest
from cleave_scripts.results.option_types import output_directory

OUT = pathlib.Path(__file__).resolve().parents[3] / "out"  # where commands write, unless told otherwise
# Words of argparse, and ours.
WORDS = (
    (r"argument (\S+): ((?:is|has) .*)", r"\1 \2"),
    (r"argument (\S+): expected (?:one|at least one) argument", r"\1 needs a value"),
    (r"argument (\S+): ignored explicit argument (.*)", r"\1 takes no value and has \2"),
    (r"the following arguments are required: (.*)", r"\1 is missing"),
)


def one_line(text):
    """Whatever a value or a file name holds: what is not printed is written out."""
    return "".join(sign if sign.isprintable() else sign.encode("unicode_escape", "backslashreplace").decode() for sign in text)


class CommandLine(argparse.ArgumentParser):
    """Options are given in full. Their types are those of option_types.py, also those of defaults that are texts."""

    def __init__(self, **options):
        self.names = []
        super().__init__(allow_abbrev=False, **options)

    def error(self, message):
        for pattern, words in WORDS:
            message = re.sub(rf"^{pattern}$", words, message, flags=re.S)
        self.exit(1, f"{self.prog}: {one_line(message)}; see {self.prog} --help\n")

    def add_argument(self, *names, **options):
        self.names += [name for name in names if name.startswith("-")]
        return super().add_argument(*names, **options)

    def add_out(self, name, words="(default %(default)s)"):
        """--out DIR, by default the directory of that name in out/. words: of its help."""
        return self.add_argument("--out", type=output_directory, default=str(OUT / name), metavar="DIR", help=words)

    def parse_args(self, args=None, namespace=None):
        options, rest = self.parse_known_args(args, namespace)
        for word in rest:
            name = word.partition("=")[0]
            if name.startswith("-"):
                self.error(f"unknown option '{name}'{nearest(name, self.names)}")
            self.error(f"nothing is asked by '{word}'")
        return options

    def checked(self, name, kind, value):
        """What an option stands for where its default depends on others: as if it had been given."""
        try:
            return kind(str(value))
        except argparse.ArgumentTypeError as error:
            return self.error(f"{name} {error}")


def refuse_unknown(option, name, known):
    """A ResultError where a name is none of those that only the results know."""
    if name not in known:
        raise ResultError(f"{option} has '{name}', expected some of {','.join(known)}{nearest(name, known)}")


def counted(number, noun):
    """'1 thread', '2 threads'"""
    return f"{number} {noun}" + ("" if str(number) == "1" else "s")
