"""What the command lines of scripts/ have in common: options, their errors, and words for numbers."""
import argparse
import re


class CommandLine(argparse.ArgumentParser):
    """Wrong options are bad input: exit code 1 and words as in the program, '--rounds is 0, expected ...'."""

    def error(self, message):
        message = re.sub(r"^argument (\S+): is ", r"\1 is ", message)
        self.exit(1, f"{self.prog}: {message}; see {self.prog} --help\n")


def at_least(least):
    """The type of an option that is a whole number from here on."""

    def parse(text):
        if not re.fullmatch(r"-?\d+", text):
            raise argparse.ArgumentTypeError(f"is '{text}', expected a whole number")
        if int(text) < least:
            raise argparse.ArgumentTypeError(f"is {text}, expected at least {least}")
        return int(text)

    return parse


def counted(number, noun):
    """'1 thread', '2 threads'"""
    return f"{number} {noun}" + ("" if str(number) == "1" else "s")
