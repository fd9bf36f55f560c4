"""Names of algorithms as rows write them: 'mindp', with parameters 'mindp@max-bodies=50', with a hash 'file@1f2e3d4c'."""
import difflib
import functools
import re

NO_PARTITIONER = "-"  # of a solver that works on the whole system


def base_name(text):
    """The algorithm, whatever its parameters."""
    return text.partition("@")[0]


@functools.cache
def said_parameters(text):
    """{parameter: value} that the name says."""
    return dict(re.findall(r"([\w-]+)=([^@,;]*)", text.partition("@")[2]))


def title(scene):
    """'Rock Pile' of 'rock_pile'."""
    return scene.replace("_", " ").title()


def nearest(name, known):
    """'; did you mean mindp?', where one of the known names is near."""
    found = difflib.get_close_matches(name, list(map(str, known)), n=1)
    return f"; did you mean {found[0]}?" if found else ""


def in_order(names, first=()):
    """Each name once: those of `first` in its order, then the others in theirs."""
    names = dict.fromkeys(names)
    return [name for name in first if name in names] + [name for name in names if name not in first]
