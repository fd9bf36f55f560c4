"""What scripts/partition_worth measured: when a partition pays.

The time of a cell is t_pr + t_s: on one thread and on two as measured, on more workers as modelled from the one-thread solve.
In a round it is put at the pace of WHOLE_SYSTEM and of kernels with ONE_PART in the same replay. Of every kernel the partition
counts that is fastest in the odd rounds, for each number of workers anew; its time is told from the even ones, by which it was
not chosen. Where a partition cuts no row, as one part does, the cell is one of the whole system, whichever kernel solved it.
Speed-ups are against the fastest on one thread.

One leads another where that takes longer by LEAST_LEAD in every even round. The fastest is what is so in the odd rounds, with
all that it does not lead. Where a scene names groups of bodies, parts after them are held against those that are found.
"""
import dataclasses
import statistics

from cleave_scripts.measurements.modelled_times import LEAST_MS, MODEL
from cleave_scripts.measurements.pace import paces_of, place
from cleave_scripts.results.names import NO_PARTITIONER, base_name
from cleave_scripts.results.rows import combination, split_ms, total_ms

KEY = ("scene", "bodies", "cfm")
MODELLED = (2, 4, 8, 16, 32, 64)
WORKERS = (1, *MODELLED)
COLUMNS = (*KEY, "step", "rows", "solver", "partitioner", "refiner", "parts", "interface_rows", "threads", "status", "t_pr_ms",
           "t_s_ms", *(f"t_s_model_p{workers}_ms" for workers in MODELLED), "round", "replay")
LEAST_LEAD = 0.03
SEMANTIC = "semantic"
WHOLE, RUNS, FOUND, UNCUT = "groups", "groups in runs", "found", "nothing cut"  # kinds of partitions
WHOLE_SYSTEM = "auto:monolithic"
ONE_PART = "single"  # a partitioner
PAPERS = "auto:schur-rows"
# Partitions of which the share of partitioning is told, and what was asked of it with PAPERS and with the fastest kernel.
SHARED = ("mindp@max-bodies=25+fm", "mix@max-bodies=25+fm", "multilevel@effort=best@max-bodies=25+fm")
ASKED_SHARES = (0.01, 0.05)
NAMES = {"auto:schur-rows": "schur-rows, the paper's", "auto:schur-bodies": "schur-bodies", "auto:schur-nested": "schur-nested",
         WHOLE_SYSTEM: "whole system"}


@dataclasses.dataclass(frozen=True)
class Cell:
    """Of a problem, with one number of workers."""
    solver: str
    partition: str  # "-" for the whole system
    parts: int
    interface_rows: int
    chosen_ms: float  # median over the odd rounds
    told_ms: tuple  # of each even round

    @property
    def time_ms(self):
        return statistics.median(self.told_ms)

    @property
    def cuts(self):
        return self.partition != NO_PARTITIONER and self.interface_rows > 0

    @property
    def kernel(self):
        """The solver, and WHOLE_SYSTEM where it had nothing to join."""
        return self.solver if self.cuts else WHOLE_SYSTEM

    def leads(self, other):
        return all(own * (1 + LEAST_LEAD) <= ms for own, ms in zip(self.told_ms, other.told_ms))


def fastest(cells):
    """Names of what is fastest, as far as the rounds tell, the least time first; cells: {name: Cell}, one or more."""
    first = min(cells.values(), key=lambda cell: cell.chosen_ms)
    return sorted((name for name, cell in cells.items() if not first.leads(cell)), key=lambda name: cells[name].time_ms)


@dataclasses.dataclass(frozen=True)
class Problem:
    key: tuple  # values of KEY
    rows: int
    best: dict  # {workers: {kernel: Cell}}, as modelled but for 1
    measured: dict  # {kernel: Cell} on two threads

    @property
    def base_ms(self):
        return min(self.best[1].values(), key=lambda cell: cell.chosen_ms).time_ms

    def speed_up(self, cell):
        return self.base_ms / cell.time_ms

    def speed_ups(self, cell):
        """The least and the greatest of a round."""
        return self.base_ms / max(cell.told_ms), self.base_ms / min(cell.told_ms)


def _modelled_ms(workers):
    return lambda row: split_ms(row) + float(row[f"t_s_model_p{workers}_ms"])


def _by_cell(rows):
    """{(solver, partition): [(row, its pace)]}; rows: of one problem, with one number of threads."""
    paces, found = paces_of(rows, lambda row: row["solver"] == WHOLE_SYSTEM or row["partitioner"] == ONE_PART), {}
    for row in rows:
        found.setdefault((row["solver"], combination(row)), []).append((row, paces[place(row)]))
    return found


def _cell(solver, partition, rows, time_ms):
    rounds = {}
    for row, pace in rows:
        rounds.setdefault(int(row["round"]), []).append(time_ms(row) / pace)
    of_round = {number: statistics.median(times) for number, times in sorted(rounds.items())}
    first = rows[0][0]
    return Cell(solver, partition, int(first["parts"]), int(first["interface_rows"]),
                statistics.median(ms for number, ms in of_round.items() if number % 2),
                tuple(ms for number, ms in of_round.items() if not number % 2))


def _cells(rows, time_ms=total_ms):
    return [_cell(*names, of_cell, time_ms) for names, of_cell in _by_cell(rows).items()]


def _best(cells, name):
    """{name(cell): the one of least time in the odd rounds}"""
    found = {}
    for cell in sorted(cells, key=lambda cell: cell.chosen_ms):
        found.setdefault(name(cell), cell)
    return found


def _kernels(rows, time_ms=total_ms):
    found = _best(_cells(rows, time_ms), lambda cell: cell.kernel)
    return {kernel: found[kernel] for kernel in NAMES if kernel in found}


def _by_problem(rows):
    """[(values of KEY, number of rows, {threads: rows})], by rows."""
    found = {}
    for row in rows:
        of_problem = found.setdefault((tuple(row[name] for name in KEY), int(row["rows"])), {})
        of_problem.setdefault(int(row["threads"]), []).append(row)
    return sorted(((key, count, threads) for (key, count), threads in found.items()),
                  key=lambda problem: (problem[0][0], problem[1], float(problem[0][2])))


def problems(rows):
    """[Problem], by rows. rows: of two rounds or more."""
    return [Problem(key, count,
                    {1: _kernels(threads[1]), **{workers: _kernels(threads[1], _modelled_ms(workers)) for workers in MODELLED}},
                    _kernels(threads[2])) for key, count, threads in _by_problem(rows)]


def _kind(cell):
    if not cell.cuts:
        return UNCUT
    if base_name(cell.partition) != SEMANTIC:
        return FOUND
    return WHOLE if "split=whole" in cell.partition else RUNS


def kinds(rows):
    """{(key, rows, solver): {kind: Cell}} on one thread, of the problems that name groups: the fastest partition of a kind."""
    found = {}
    for key, count, threads in _by_problem(rows):
        cells = _cells(threads[1])
        if not any(base_name(cell.partition) == SEMANTIC for cell in cells):
            continue
        for solver in NAMES:
            of_kind = _best([cell for cell in cells if cell.solver == solver and cell.partition != NO_PARTITIONER], _kind)
            if of_kind:
                found[key, count, solver] = of_kind
    return found


def partition_shares(rows):
    """{(key, rows): {partition: {solver: (t_pr over t_s, t_pr + t_s)}}} on one thread, of SHARED; medians over the rounds."""
    found = {}
    for key, count, threads in _by_problem(rows):
        of_problem = found[key, count] = {}
        for (solver, partition), of_cell in _by_cell(threads[1]).items():
            if partition in SHARED:
                share = statistics.median(split_ms(row) / float(row["t_s_ms"]) for row, _ in of_cell)
                of_problem.setdefault(partition, {})[solver] = share, statistics.median(total_ms(row) / pace
                                                                                        for row, pace in of_cell)
    return found


@dataclasses.dataclass(frozen=True)
class ModelError:
    """Of a cell on two workers."""
    measured_ms: float  # t_s, median over the rounds
    error: float  # modelled over measured, less 1

    @property
    def slow(self):
        return self.measured_ms >= LEAST_MS


def _medians(rows, column):
    return {names: statistics.median(float(row[column]) / pace for row, pace in of_cell)
            for names, of_cell in _by_cell(rows).items()}


def model_errors(rows):
    """[ModelError] of all cells."""
    found = []
    for _, _, threads in _by_problem(rows):
        modelled, measured = _medians(threads[1], MODEL), _medians(threads[2], "t_s_ms")
        found += [ModelError(ms, modelled[names] / ms - 1) for names, ms in measured.items()]
    return found
