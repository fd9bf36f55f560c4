"""The places in a document that are generated: <!-- generated: NAME --> ... <!-- end -->."""
import re

from cleave_scripts.results.errors import ResultError

PLACE = re.compile(r"(<!-- generated: (\w+) -->\n)(.*?)(<!-- end -->)", re.S)


def names(text):
    return [match[2] for match in PLACE.finditer(text)]


def outside(text):
    """What stands outside of the generated places."""
    return PLACE.sub("", text)


def fill(text, make, path="text"):
    """The text with make(name) in every place."""
    found = PLACE.findall(text)
    if text.count("<!-- generated:") != len(found) or text.count("<!-- end -->") != len(found):
        raise ResultError(f"{path}: a generated place does not begin or does not end")
    return PLACE.sub(lambda match: match[1] + make(match[2]).rstrip("\n") + "\n" + match[4], text)
