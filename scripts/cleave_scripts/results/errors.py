"""What is told to the user in one line."""


class ResultError(Exception):
    """Results that cannot be read; the text is for the user."""
