"""What scripts/modelled_workers measured: the model of one-thread solves against solves on two threads.

Of every step the fastest round counts, on one thread and on two: on machines that share their cores with others every solve
of a replay can take a third longer, for a second or so, without any waiting that the system would see, and it hits one
round here and another there. How far medians over the rounds are apart is told beside it.
"""
import dataclasses
import statistics

from cleave_scripts.table import text
from cleave_scripts.table.cells import MOST_WAITING

LEAST_MS = 5  # measured on two threads; a median error is that of steps of at least this
MOST_ERROR = 0.15
SLOW = f"steps of {LEAST_MS} ms and more on two threads"
KEY = ("scene", "bodies", "cfm", "step", "solver")
COSTS = ("task_us", "graph_task_us", "timing_us", "stage_us")
MODEL = "t_s_model_p2_ms"
WORKERS = "16"  # of a speed-up
ASKED = {600: 6, 10000: 10}  # bodies: speed-up
SHOWN = {WORKERS: "t_s_model_p16_ms", "64": "t_s_model_p64_ms", "as many as tasks": "t_s_critical_path_ms"}
HEADER = ("scene", "bodies", "cfm", "step", "solver", "one thread, ms", "modelled on 2", "measured on 2", "error",
          *(f"modelled on {workers}" for workers in SHOWN))


@dataclasses.dataclass
class Step:
    key: tuple  # values of KEY
    one_ms: float
    modelled_ms: float  # on two workers
    measured_ms: float  # on two threads
    more_ms: list  # modelled, as SHOWN
    median_error: float  # modelled over measured, both medians over the rounds, less 1

    @property
    def problem(self):
        return self.key[:-1]

    @property
    def solver(self):
        return self.key[-1]

    @property
    def on_workers_ms(self):
        """Modelled on WORKERS."""
        return self.more_ms[list(SHOWN).index(WORKERS)]

    @property
    def error(self):
        return self.modelled_ms / self.measured_ms - 1

    @property
    def slow(self):
        return self.measured_ms >= LEAST_MS


def has_waited(row):
    """Too long for a core, a thread, so that t_s says more of the machine's other work."""
    return float(row["t_s_waiting_ms"]) > MOST_WAITING * float(row["t_s_ms"]) * int(row["threads"])


def waited_in_words(count):
    return f"Solves that waited more than {100 * MOST_WAITING:.0f} % of t_s a thread for a core are left out: {count}."


def _step(key, one, two):
    def fastest(rows):
        return min(rows, key=lambda row: float(row["t_s_ms"]))

    def median(rows, column):
        return statistics.median(float(row[column]) for row in rows)

    best = fastest(one)
    return Step(key, float(best["t_s_ms"]), float(best[MODEL]), float(fastest(two)["t_s_ms"]),
                [float(best[column]) for column in SHOWN.values()], median(one, MODEL) / median(two, "t_s_ms") - 1)


def compare(rows):
    """([Step], number of solves that waited for a core and are left out)"""
    cells, waited = {}, 0
    for row in rows:
        if has_waited(row):
            waited += 1
        else:
            cells.setdefault(tuple(str(row[column]) for column in KEY), {}).setdefault(int(row["threads"]), []).append(row)
    return [_step(key, cell[1], cell[2]) for key, cell in cells.items() if 1 in cell and 2 in cell], waited


def median_error(steps):
    """Of the steps that are slow enough; there has to be one."""
    return statistics.median(abs(step.error) for step in steps if step.slow)


def _line(step):
    scene, bodies, cfm, *rest = step.key
    return [scene, bodies, f"{float(cfm):g}", *rest, *map(text.number, (step.one_ms, step.modelled_ms, step.measured_ms)),
            f"{100 * step.error:+.0f} %", *map(text.number, step.more_ms)]


def lines_of_steps(steps, waited):
    """A table of the slow steps, one of the others, and what was left out."""
    parts = []
    for slow in (True, False):
        chosen = [step for step in steps if step.slow == slow]
        if not chosen:
            continue
        least, middle, most = (100 * value for value in (min(step.error for step in chosen),
                                                         statistics.median(abs(step.error) for step in chosen),
                                                         max(step.error for step in chosen)))
        title = SLOW if slow else f"steps below {LEAST_MS} ms"
        of_medians = 100 * statistics.median(abs(step.median_error) for step in chosen)
        parts.append(f"{title[0].upper()}{title[1:]}: {len(chosen)}, median error {middle:.1f} %, from {least:+.0f} to "
                     f"{most:+.0f} %; with medians over the rounds in place of the fastest, median error "
                     f"{of_medians:.1f} %.\n\n{text.table(HEADER, map(_line, chosen))}")
    parts.append(waited_in_words(waited))
    return "\n\n".join(parts)


@dataclasses.dataclass(frozen=True)
class SpeedUp:
    """Of a problem, whichever solver is the fastest."""
    one: Step  # of least time on one thread
    modelled: Step  # of least modelled time

    @property
    def ratio(self):
        return self.one.one_ms / self.modelled.on_workers_ms

    @property
    def asked(self):
        return ASKED[int(self.one.problem[1])]


def speed_ups(steps):
    """[SpeedUp] of the problems of so many bodies that something was asked of them."""
    of_problem = {}
    for step in steps:
        if int(step.problem[1]) in ASKED:
            of_problem.setdefault(step.problem, []).append(step)
    return [SpeedUp(min(found, key=lambda step: step.one_ms), min(found, key=lambda step: step.on_workers_ms))
            for found in of_problem.values()]


def lines_of_speed_ups(steps):
    """A table; nothing where no problem has so many bodies."""
    def line(found):
        scene, bodies, cfm, step = found.one.problem
        return [scene, bodies, f"{float(cfm):g}", step, f"{text.number(found.one.one_ms)} (`{found.one.solver}`)",
                f"{text.number(found.modelled.on_workers_ms)} (`{found.modelled.solver}`)", text.number(found.ratio),
                f"{found.asked}, {text.holds(found.ratio >= found.asked)}"]
    lines = [line(found) for found in speed_ups(steps)]
    if not lines:
        return ""
    header = (*KEY[:-1], "fastest on one thread, ms", f"least modelled on {WORKERS}, ms", "speed-up", "asked")
    return (f"The fastest on one thread over the least modelled time on {WORKERS} workers, of any of these "
            f"solvers:\n\n{text.table(header, lines)}")


def lines_of_costs(rows):
    """What was charged, medians over the one-thread solves."""
    task, graph_task, timing, stage = (statistics.median(float(row[name]) for row in rows if int(row["threads"]) == 1)
                                       for name in COSTS)
    return (f"Charged: {1000 * task:.0f} ns an independent task and {1000 * graph_task:.0f} ns a task of a graph, less the "
            f"{1000 * timing:.0f} ns of its timing on one thread, and {text.number(stage)} µs a parallel stage.")
