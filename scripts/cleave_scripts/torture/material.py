"""What trials start from: problem files and output directories that the program has just made, and how long that took."""
import dataclasses
import functools
import pathlib
import time

from cleave_scripts.results.errors import ResultError, last_line
from cleave_scripts.torture import campaigns, child

SECONDS = 600
SCENES = (
    ("rock_pile", ("--bodies", "8"), (40, 70)),
    ("large_rock_pile", ("--bodies", "6"), (50,)),
    ("chain_drop", ("--links", "6"), (30,)),
    ("log_tower", ("--layers", "2", "--logs", "2"), (10,)),
    ("ladder_alternating", ("--boxes", "3"), (5,)),
)
COMBINATIONS = ("--partitioner", "mindp,mix", "--refiner", "none,fm", "--solver", "schur,pgs", "--max-bodies", "3",
                "--repeats", "1")
RUN = ("run", "--scene", "rock_pile", "--bodies", "20", "--steps", "80", "--measure-every", "8", "--refiner", "all",
       "--repeats", "1")
RECORD = ("record", "--scene", "rock_pile", "--bodies", "30", "--at", "10,40,60,80,100,120", "--repeats", "1")


@dataclasses.dataclass(frozen=True)
class Undisturbed:
    """A command without --out, the directory that it made, and how long it took."""
    words: tuple
    directory: pathlib.Path
    seconds: float


class Material:

    def __init__(self, program, directory):
        self.program, self.directory = program, directory

    @functools.cached_property
    def problems(self):
        """Problem files of small scenes, each as recorded."""
        files = []
        for scene, options, steps in SCENES:
            out = self._make("problems/" + scene, ("record", "--scene", scene, *options, "--at", ",".join(map(str, steps))))
            files += [out.directory / f"{scene}_step{step:06}.h5" for step in steps]
        return files

    @functools.cached_property
    def solved(self):
        """The same with solutions and partitions in them."""
        out = self._make("solved", ("replay", *self.problems, *COMBINATIONS, "--write-solutions"))
        return [out.directory / path.name for path in self.problems]

    @functools.cached_property
    def undisturbed(self):
        """{name: Undisturbed} of every command that writes a directory."""
        recorded = self._make("record", RECORD)
        files = sorted(recorded.directory.glob("*.h5"))
        return {
            "record": recorded,
            "replay": self._make("replay", ("replay", *files, *COMBINATIONS, "--write-solutions")),
            "run": self._make("run", RUN),
            "run --record-motion": self._make("motion", (*RUN, "--record-motion")),
        }

    @functools.cached_property
    def campaign(self):
        """The directory of one of many cells."""
        return campaigns.make(self.program, self.directory)

    @functools.cached_property
    def mixed_campaign(self):
        """The directory of one that has all kinds of files."""
        return campaigns.make_mixed(self.program, self.directory)

    def _make(self, name, words):
        out = self.directory / name
        out.parent.mkdir(parents=True, exist_ok=True)
        begin = time.monotonic()
        ending = child.finish(child.start([self.program, *words, "--out", out], self.directory), SECONDS)
        if ending.code not in (0, 2):
            raise ResultError(f"nothing to try: {words[0]} stopped with exit code {ending.code}: {last_line(ending.err)}")
        return Undisturbed(words, out, time.monotonic() - begin)
