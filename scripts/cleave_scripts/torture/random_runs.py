"""Random scenes, options and combinations: every solution that a replay writes is judged, and a run has the same rows."""
from cleave_scripts.torture import scene_dice
from cleave_scripts.torture.endings import BAD_INPUT, DONE, ROWS_FAILED
from cleave_scripts.torture.rows import judge_rows, read_rows

MOST_EVERY = 40
MEASURED = 2
KEY = ("step", "partitioner", "refiner", "solver")
SAME = ("problem_hash", "solution_hash", "status", "residual_m_per_s")


def trial(trial):
    world, combinations = scene_dice.world(trial.random), scene_dice.combinations(trial.random)
    shared = scene_dice.advance(trial.random)
    every = trial.random.randrange(1, MOST_EVERY)
    steps = [every * (number + 1) - 1 for number in range(MEASURED)]
    # A world that stops before a step is reached leaves that step out, and the exit code says so.
    recorded = trial.run("record", *world, *shared, "--at", ",".join(map(str, steps)), "--out", "recorded",
                         allowed=(DONE, BAD_INPUT, ROWS_FAILED))
    files = sorted((trial.directory / "recorded").glob("*.h5"))
    if recorded.code == BAD_INPUT or not files:
        trial.count("refused")
        return
    replayed = trial.run("replay", *(f"recorded/{path.name}" for path in files), *combinations, *shared,
                         "--write-solutions", "--out", "replayed", allowed=(DONE, BAD_INPUT, ROWS_FAILED))
    if replayed.code == BAD_INPUT:
        trial.count("refused")
        return
    trial.count("accepted")
    judge_rows(trial, trial.directory / "replayed", {path.name: path for path in files})
    trial.run("verify", "recorded", "replayed", allowed=(DONE, ))
    _compare_with_run(trial, [*world, *combinations, *shared, "--steps", steps[-1] + 1, "--measure-every", every])


def _compare_with_run(trial, words):
    """A row of the run that has the impulses of a judged row is judged as that was."""
    if trial.run("run", *words, "--out", "run", allowed=(DONE, ROWS_FAILED)).code not in (DONE, ROWS_FAILED):
        return
    replayed = {_key(row): row for row in read_rows(trial, trial.directory / "replayed" / "steps.csv")}
    for row in read_rows(trial, trial.directory / "run" / "steps.csv"):
        if other := replayed.get(_key(row)):
            different = [(name, row[name], other[name]) for name in SAME if row[name] != other[name]]
            if different:
                trial.find("run and replay differ", f"{_key(row)}: {different}")
            else:
                trial.count("judged")


def _key(row):
    return tuple(row[name] for name in KEY)
