"""What an exact answer costs by other people's solvers: the same recorded steps of settled rock piles by `exact` and by theirs,
in turn."""
import collections
import dataclasses
import math
import pathlib
import statistics

from cleave_scripts.results.programs import record, replay
from cleave_scripts.results.rows import group
from cleave_scripts.table import text

ROCKS = (30, 80, 200)
STEPS = (300, 350, 400)  # a pile has come to rest
OURS = "exact"
PEERS = ("bullet-dantzig", "bullet-lemke", "bullet-pgs@sweeps=100", "dart-dantzig", "dart-pgs@sweeps=100",
         "ipopt@peer-tolerance=1e-8", "ipopt@peer-tolerance=1e-12")
MUJOCO = {"mujoco-constraint": "t_constraint_ms", "mujoco-step": "t_step_ms"}  # solver: what cleave_mujoco calls its time
REPEATS = 5  # of solves that are no process of their own
MOST_ROWS = 5000  # of a problem; a peer takes 0.2 GB for such a matrix
SLOW_MS = 2000  # what took longer is not solved again
ASKED_ROCKS = 200
ASKED = {"bullet-dantzig": 2000, "dart-dantzig": 2000, "ipopt@peer-tolerance=1e-8": 12}  # times the time of OURS, at least
COLUMNS = ("scene", "bodies", "step", "round", "rows", "solver", "status", "residual_m_per_s", "t_s_ms", "peer_timeout_s")


@dataclasses.dataclass
class Step:
    file: pathlib.Path
    peers: tuple = PEERS  # that solve it in the next round

    def replay(self, program, directory, number, timeout_s):
        """A row a solver. Ours begins, and in rounds of an even number it ends."""
        turns = [self._ours, self._theirs] if number % 2 else [self._theirs, self._ours]
        rows = [row | {"round": number} for turn in turns for row in turn(program, directory, timeout_s)]
        self.peers = tuple(row["solver"] for row in rows if row["solver"] in self.peers and float(row["t_s_ms"]) <= SLOW_MS)
        return rows

    def _ours(self, program, directory, _):
        return replay(program, directory, [self.file], "--solver", OURS, "--threads", 1, "--repeats", REPEATS, all_ok=True)

    def _theirs(self, program, directory, timeout_s):
        if not self.peers:
            return []
        return replay(program, directory, [self.file], "--solver", ",".join(self.peers), "--threads", 1, "--repeats", 1,
                      "--peer-max-rows", MOST_ROWS, "--peer-timeout-s", f"{timeout_s:g}")


def record_steps(program, directory, rocks):
    files = record(program, directory / f"rocks_{rocks}", "rock_pile", STEPS, "--bodies", rocks, "--advance", "exact",
                   "--repeats", 1, "--threads", 2)
    return [Step(file) for file in files]


def mujoco_rows(row, result):
    """What cleave_mujoco said of a step, beside a row of it: another model, whose answers nobody judges."""
    return [{"scene": row["scene"], "bodies": row["bodies"], "step": row["step"], "round": row["round"], "rows": result["rows"],
             "solver": solver, "status": "-", "residual_m_per_s": "nan", "t_s_ms": result[column], "peer_timeout_s": "-"}
            for solver, column in MUJOCO.items()]


@dataclasses.dataclass(frozen=True)
class Price:
    """Of a solver on a pile: medians over the steps in which it came to a time or was ended."""
    rows: float
    t_s_ms: float
    against_ours: float
    is_least: bool  # where a step was ended, which counts with the time it was given
    residual_m_per_s: float  # the largest
    statuses: collections.Counter

    def said(self, value):
        return f"{'at least ' if self.is_least else ''}{text.number(value)}"

    def status_in_words(self):
        steps = self.statuses.total()
        return ", ".join(status if count == steps else f"{status} {count} of {steps}"
                         for status, count in self.statuses.items())


def _time_ms(row):
    return 1000 * float(row["peer_timeout_s"]) if row["status"] == "timeout" else float(row["t_s_ms"])


def _step_ms(rows):
    """{step: median over the rounds}"""
    return {step: statistics.median(map(_time_ms, of_step)) for (step,), of_step in group(rows, "step").items()}


def _median(values):
    return statistics.median(values) if values else math.nan


def _price(rows, ours_ms):
    firsts = [of_step[0] for of_step in group(rows, "step").values()]
    times_ms = {step: ms for step, ms in _step_ms(rows).items() if not math.isnan(ms)}
    residuals = [float(row["residual_m_per_s"]) for row in firsts]
    return Price(rows=statistics.median(float(row["rows"]) for row in firsts), t_s_ms=_median(times_ms.values()),
                 against_ours=_median([ms / ours_ms[step] for step, ms in times_ms.items()]),
                 is_least=any(row["status"] == "timeout" for row in rows),
                 residual_m_per_s=max((residual for residual in residuals if not math.isnan(residual)), default=math.nan),
                 statuses=collections.Counter(row["status"] for row in firsts))


def prices(rows):
    """{rocks: {solver: Price}}, the smallest pile first."""
    found = {}
    for (bodies,), of_pile in sorted(group(rows, "bodies").items(), key=lambda item: int(item[0][0])):
        by_solver = {solver: of_solver for (solver,), of_solver in group(of_pile, "solver").items()}
        ours_ms = _step_ms(by_solver[OURS])
        found[int(bodies)] = {solver: _price(of_solver, ours_ms) for solver, of_solver in by_solver.items()}
    return found


def growth(small, large):
    """The power of the rows with which the time grows from one pile to another, in words."""
    if small.is_least or small.rows == large.rows:
        return "-"
    power = math.log(large.t_s_ms / small.t_s_ms) / math.log(large.rows / small.rows)
    return "-" if math.isnan(power) else f"{'at least ' if large.is_least else ''}{power:.1f}"


def _line(solver, of_piles):
    cells = [cell for price in of_piles
             for cell in (f"{price.said(price.t_s_ms)} ({price.said(price.against_ours)})",
                          "another model" if solver in MUJOCO else
                          f"{text.number(price.residual_m_per_s)} ({price.status_in_words()})")]
    return [f"`{solver}`", *cells, growth(of_piles[0], of_piles[-1])]


def table(found):
    """A line a solver: time, in brackets as a multiple of ours, and the residual with the status."""
    header = [cell for rocks, of_pile in found.items()
              for cell in (f"{rocks} rocks, {of_pile[OURS].rows:.0f} rows: ms (times `{OURS}`)", "residual, m/s (status)")]
    return text.table(["", *header, "grows with the rows to the power"],
                      [_line(solver, [of_pile[solver] for of_pile in found.values()]) for solver in next(iter(found.values()))])


def verdict(price, asked):
    if math.isnan(price.against_ours):
        return f"not measured ({price.status_in_words()})"
    if price.is_least and price.against_ours < asked:
        return "cannot be told, as it was ended"
    return text.holds(price.against_ours >= asked)


def sentences(found):
    """One a limit that is asked, and what MuJoCo takes; of a run without that pile there is none."""
    for solver, asked in ASKED.items() if ASKED_ROCKS in found else ():
        price = found[ASKED_ROCKS][solver]
        yield (f"`{solver}` takes {price.said(price.against_ours)} times as long as `{OURS}` on {ASKED_ROCKS} rocks and solves "
               f"{price.statuses['ok']} of {price.statuses.total()} steps exactly; asked: at least {asked} times: "
               f"{verdict(price, asked)}.")
    if ASKED_ROCKS in found:
        constraint, step = (text.number(found[ASKED_ROCKS][solver].against_ours) for solver in MUJOCO)
        yield (f"MuJoCo's constraints take {constraint} times as long as `{OURS}` on {ASKED_ROCKS} rocks, its whole step "
               f"{step} times; it solves another model, so nothing is asked of it.")


def markdown(rows):
    """The table and the sentences."""
    found = prices(rows)
    return table(found), "\n".join(f"- {sentence}" for sentence in sentences(found))
