"""Command lines with words that are wrong, missing, doubled, moved or strange: refused in one line, or carried out."""
import dataclasses

from cleave_scripts.torture.endings import BAD_INPUT, CHECK_FAILED, DONE, ROWS_FAILED

LINES = (
    ("run", "--scene", "rock_pile", "--bodies", "4", "--steps", "6", "--measure-every", "3", "--partitioner", "mindp,mix",
     "--refiner", "none,fm", "--solver", "schur,pgs@sweeps=3", "--mu", "0.4", "--dt", "0.01", "--repeats", "1", "--out",
     "out"),
    ("record", "--scene", "chain_drop", "--links", "3", "--at", "2,5", "--cfm", "1e-6", "--seed", "3", "--out", "out"),
    ("replay", "problem.h5", "--partitioner", "mix@max-bodies=3", "--refiner", "kl", "--solver", "monolithic", "--threads",
     "2", "--cold", "--out", "out"),
    ("verify", "problem.h5"),
    ("export", "problem.h5", "--format", "metis", "--out", "graph"),
    ("list", "solvers", "--names"),
)
WORDS = ("", "-", "--", "-1", "0", "nan", "inf", "-inf", "1e400", "1e-320", "0x10", "1.5", "+1", " 1", "1 ", "1,", ",", ",1",
         "1,,2", "99999999999999999999", "-99999999999999999999", "abc", "\u00e9", "\x1b[31m", "a\nb", "x" * 4000, "@", "=",
         "mindp@", "mix@max-bodies=", "mix@max-bodies=1@max-bodies=2", "mix@x=1", "all", "all,mix", "mix,mix", "pivot:", ":",
         "a:b:c", "--nope", "--nope=1", "--scene", "--out", "--out=", "--steps", "--force", "--help", "--version", "run",
         "verify", "/nowhere", ".", "/dev/null", "/dev/full", "problem.h5", "../problem.h5", "--threads=0", "--repeats=0",
         "--seed=-1", "--config", "%s%n")
MOST_CHANGES = 3


def trial(trial):
    name = "problem.h5"
    (trial.directory / name).write_bytes(trial.material.problems[0].read_bytes())
    words = list(trial.random.choice(LINES))
    for _ in range(trial.random.randrange(1, MOST_CHANGES + 1)):
        trial.random.choice([_replaced, _inserted, _removed, _doubled, _swapped])(trial.random, words)
    ending = trial.run(*(words or ["--"]), allowed=(DONE, BAD_INPUT, ROWS_FAILED, CHECK_FAILED))
    trial.findings[:] = [dataclasses.replace(found, what=f"command line: {found.what.rpartition(': ')[2]}")
                         for found in trial.findings]
    trial.count("refused" if ending.code == BAD_INPUT else "accepted")
    left = sorted(path.name for path in trial.directory.iterdir() if path.name != name)
    if ending.code == BAD_INPUT and left:
        trial.find("a command line that is refused leaves files", str(left))


def _replaced(dice, words):
    if words:
        words[dice.randrange(len(words))] = dice.choice(WORDS)


def _inserted(dice, words):
    words.insert(dice.randrange(len(words) + 1), dice.choice(WORDS))


def _removed(dice, words):
    if words:
        del words[dice.randrange(len(words))]


def _doubled(dice, words):
    if words:
        words.append(dice.choice(words))


def _swapped(dice, words):
    if len(words) > 1:
        first, second = dice.sample(range(len(words)), 2)
        words[first], words[second] = words[second], words[first]
