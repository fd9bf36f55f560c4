"""What is told to the user in one line."""


class ResultError(Exception):
    """Bad input, or results that cannot be read; the text is for the user."""


class AlreadyTold(Exception):
    """A program has failed and has said itself why."""


class Interrupted(Exception):
    """Stopped by the user or from outside; the text says how to go on, if there is more to say than that."""


def last_line(said, otherwise="no message"):
    """Of what a program said, which then tells why it failed."""
    return (said.strip().splitlines() or [otherwise])[-1]
