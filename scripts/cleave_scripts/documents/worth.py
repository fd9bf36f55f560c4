"""What partitions are worth: which solver is fastest with its best partition,
and what taking over parts from step to step saves."""
import math
import statistics

from cleave_scripts.documents.stored import NoResults, need
from cleave_scripts.measurements import modelled_times, partition_over_time, partition_worth
from cleave_scripts.table import text

OVER_TIME = ("partition_over_time.csv", "scripts/partition_over_time")
WORTH = ("partition_worth.csv", "scripts/partition_worth")
SHOWN_WORKERS = (8, 64)


def _course_cell(course, always):
    shares = " / ".join(f"{100 * share:.0f}" for share in course.shares.values())
    return ", ".join(text.number(ratio(always)) for ratio in (course.saving, course.rows, course.t_s)) + f" ({shares})"


def over_time(stored):
    """Saving of t_pr and change of the cut by every rule of --repartition."""
    rows = need(stored.table(*OVER_TIME), "repartitioning", "repartition")
    always, *rules = partition_over_time.RULES
    lines = [[f"{scene.replace('_', ' ')}, {partitioner}+{refiner}", text.number(found[always].t_pr_ms / found[always].t_s_ms),
              *(_course_cell(found[rule], found[always]) for rule in rules)]
             for (scene, partitioner, refiner), found in partition_over_time.courses(rows).items()]
    return ("t_pr of `always` over its t_s (one thread, `auto:schur-bodies`), then how many times less t_pr a rule takes than "
            "`always`, its interface rows and its t_s against those of `always`, and of a hundred steps those with fresh / "
            f"repaired / kept parts; sums over all steps with a constraint ({stored.origin(OVER_TIME[0])}):\n\n" +
            text.table(["", "t_pr / t_s", *rules], lines))


def _worth_rows(stored, what, *columns):
    """Rows of rounds; where only one was measured, as was done before, that is no measurement."""
    rows = need(stored.table(*WORTH), what, *columns)
    if "round" not in rows[0]:
        raise NoResults(f"What is stored tells no noise, as each cell was timed once: `{WORTH[1]}` makes `results/{WORTH[0]}` "
                        "anew, in rounds.")
    return rows


def _partition(cell):
    return _named(cell.partition)


def _named(partition):
    return partition.replace("@effort=best", ", best").replace("@split=", ", ").replace("@max-bodies=", ", ")


def _parts(cell):
    return "one part" if cell.parts == 1 else f"{cell.parts} parts, {cell.interface_rows} interface rows"


def _kernel(name):
    return partition_worth.NAMES[name].partition(",")[0]


def _worth_cell(cells, kernel):
    if kernel not in cells:
        return "-"
    cell = cells[kernel]
    if cell.cuts:
        return f"{text.number(cell.time_ms)} ({_partition(cell)})"
    return (text.number(cell.time_ms) +
            (f" ({_kernel(cell.solver)}, {_partition(cell)}: {_parts(cell)})" if cell.solver != kernel else ""))


def _fastest(cells, name=str):
    """What is named in a column of winners; cells: {what: Cell}"""
    found = partition_worth.fastest(cells)
    return f"{'undecided: ' if len(found) > 1 else ''}{text.listed(map(name, found), 'or')}"


def _winner(problem, cells):
    first = cells[partition_worth.fastest(cells)[0]]
    return f"{_fastest(cells, _kernel)}, {text.number(problem.speed_up(first))}"


def _rule(rows):
    return (f"Of {len({row['round'] for row in rows})} rounds the odd ones choose the partition and the even ones tell "
            f"its time; every replay is put at the pace of `{partition_worth.WHOLE_SYSTEM}` and of kernels with one part "
            f"(`{partition_worth.ONE_PART}`) in it. What is fastest in the odd rounds is named where every other takes at "
            f"least {100 * partition_worth.LEAST_LEAD:.0f} % longer in each even one; those that do not are undecided with it")


def _model(rows):
    """What the file says of the model on as many workers as were measured."""
    errors = partition_worth.model_errors(rows)
    of_all = statistics.median(abs(item.error) for item in errors)
    slow = [abs(item.error) for item in errors if item.slow]
    of_slow = (f", by {100 * statistics.median(slow):.1f} % of the {len(slow)} that take {modelled_times.LEAST_MS} ms and more"
               if slow else "")
    low = sum(item.error < 0 for item in errors) / len(errors)
    return (f"On two workers t_s is both modelled and measured, of {len(errors)} cells: the model is off by "
            f"{100 * of_all:.1f} % in the median{of_slow}, and too low in {text.percent(low)} of all.")


def worth(stored):
    """The least t_pr + t_s of every kernel with a cut and of the whole system, and who wins on more workers."""
    rows = _worth_rows(stored, "partitions and their worth", "threads")
    lines = []
    for problem in partition_worth.problems(rows):
        scene, bodies, cfm = problem.key
        lines.append([f"{scene.replace('_', ' ')}, {bodies} bodies, {problem.rows} rows, cfm {float(cfm):g}",
                      *(_worth_cell(problem.best[1], kernel) for kernel in partition_worth.NAMES),
                      _fastest(problem.best[1], _kernel),
                      *(_winner(problem, cells)
                        for cells in (problem.measured, *(problem.best[workers] for workers in SHOWN_WORKERS)))])
    return ("Least t_pr + t_s over all partitions tried, ms, one thread: of every kernel with a partition that cuts rows, "
            "and of the whole system, which kernels solve too where nothing is cut. In brackets the partition that gave it: "
            f"partitioner, its effort or split, most bodies of a part, refiner (`{WORTH[1]}`; {stored.origin(WORTH[0])}). Then "
            f"the fastest on one thread and on two, and of the modelled {' and '.join(map(str, SHOWN_WORKERS))} workers, with "
            f"the speed-up against the fastest on one. {_rule(rows)}, with the speed-up of the first:\n\n" +
            text.table(["", *partition_worth.NAMES.values(), "one thread", "two threads",
                        *(f"{workers} workers" for workers in SHOWN_WORKERS)], lines) + f"\n\n{_model(rows)}")


def semantic(stored):
    """Parts after the groups that a scene names against parts that are found."""
    rows = _worth_rows(stored, "semantic parts", "parts")
    kinds = (partition_worth.WHOLE, partition_worth.RUNS, partition_worth.FOUND, partition_worth.UNCUT)
    lines = [[f"{scene.replace('_', ' ')}, {bodies} bodies, {count} rows", partition_worth.NAMES[solver],
              *(f"{text.number(of_kind[kind].time_ms)} ({_partition(of_kind[kind])}: {_parts(of_kind[kind])})"
                if kind in of_kind else "-" for kind in kinds),
              _fastest(of_kind)] for ((scene, bodies, _), count, solver), of_kind in partition_worth.kinds(rows).items()]
    return ("Least t_pr + t_s, ms, one thread, of parts after the groups of bodies that the scene names (`semantic`: whole, "
            "and cut into runs), of all parts that are found from the graph, and of partitions that cut no row, each with its "
            f"best size and refiner (`{WORTH[1]}`; {stored.origin(WORTH[0])}). {_rule(rows)}:\n\n" +
            text.table(["", "kernel", *kinds, "fastest"], lines))


def _shares(of_solver):
    """t_pr over t_s by the paper's kernel, where it was tried, and by the fastest; of_solver: {solver: (share, time)}"""
    paper = of_solver.get(partition_worth.PAPERS)
    return paper[0] if paper else math.nan, min(of_solver.values(), key=lambda share_and_time: share_and_time[1])[0]


def _of_hundred(share):
    return "-" if math.isnan(share) else f"{100 * share:.1f}"


def partition_share(stored):
    """t_pr as a share of t_s, on every scene."""
    rows = _worth_rows(stored, "the share of partitioning", "threads")
    lines, told = [], []
    for ((scene, bodies, cfm), count), of_problem in partition_worth.partition_shares(rows).items():
        shares = {partition: _shares(of_solver) for partition, of_solver in of_problem.items()}
        told += shares.values()
        lines.append([f"{scene.replace('_', ' ')}, {bodies} bodies, {count} rows, cfm {float(cfm):g}",
                      *(" / ".join(map(_of_hundred, shares[partition])) if partition in shares else "-"
                        for partition in partition_worth.SHARED)])
    held = [sum(share <= asked for share in of_side) for of_side, asked in zip(zip(*told), partition_worth.ASKED_SHARES)]
    asked = " and ".join(f"{100 * share:.0f} %" for share in partition_worth.ASKED_SHARES)
    return (f"t_pr as a share of t_s, %, one thread, with the paper's kernel / with the fastest one (`{WORTH[1]}`; "
            f"{stored.origin(WORTH[0])}); aimed at are {asked}, which {held[0]} and {held[1]} of {len(told)} cells keep:\n\n" +
            text.table(["", *map(_named, partition_worth.SHARED)], lines))


BLOCKS = {"over_time": over_time, "worth": worth, "semantic": semantic, "partition_share": partition_share}
