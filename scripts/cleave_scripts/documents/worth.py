"""What partitions are worth: which solver is fastest with its best partition, and what taking over parts from step to step saves."""
from cleave_scripts.documents.stored import need
from cleave_scripts.measurements import partition_over_time, partition_worth, regret
from cleave_scripts.table import text

OVER_TIME = ("partition_over_time.csv", "scripts/partition_over_time")
WORTH = ("partition_worth.csv", "scripts/partition_worth")
REGRET = ("partition_regret.csv", "scripts/partition_regret")
SHOWN_WORKERS = (8, 64)


def _course_cell(course, always):
    shares = " / ".join(f"{100 * share:.0f}" for share in course.shares.values())
    return f"{text.number(course.saving(always))}, {text.number(course.rows(always))} ({shares})"


def over_time(stored):
    """Saving of t_pr and change of the cut by every rule of --repartition."""
    rows = need(stored.table(*OVER_TIME), "repartitioning", "repartition")
    always, *rules = partition_over_time.RULES
    lines = [[f"{scene.replace('_', ' ')}, {partitioner}+{refiner}", text.number(found[always].t_pr_ms / found[always].t_s_ms),
              *(_course_cell(found[rule], found[always]) for rule in rules)]
             for (scene, partitioner, refiner), found in partition_over_time.courses(rows).items()]
    return (f"t_pr of `always` over its t_s (one thread, `auto:schur-bodies`), then how many times less t_pr a rule takes than `always`, its "
            "interface rows against those of `always`, and of a hundred steps those with fresh / repaired / kept parts; sums over all steps "
            f"with a constraint ({stored.origin(OVER_TIME[0])}):\n\n" + text.table(["", "t_pr / t_s", *rules], lines))


def _partition(cell):
    return cell.partition.replace("@effort=best", ", best").replace("@split=", ", ").replace("@max-bodies=", ", ")


def _worth_cell(cell):
    return text.number(cell.time_ms) + ("" if cell.partition == "-" else f" ({_partition(cell)})")


def _winner(problem, workers):
    solver = problem.winner(workers)
    return f"{partition_worth.NAMES[solver].split(',')[0]}, {text.number(problem.speed_up(solver, workers))}"


def worth(stored):
    """The least t_pr + t_s of every solver, and who wins on more workers."""
    problems = partition_worth.problems(need(stored.table(*WORTH), "partitions and their worth", "threads"))
    lines = []
    for problem in problems:
        scene, bodies, cfm = problem.key
        two = min(problem.measured, key=lambda solver: problem.measured[solver].time_ms)
        lines.append([f"{scene.replace('_', ' ')}, {bodies} bodies, {problem.rows} rows, cfm {float(cfm):g}",
                      *(_worth_cell(problem.best[solver, 1]) for solver in partition_worth.NAMES),
                      f"{partition_worth.NAMES[two].split(',')[0]}, {text.number(problem.base_ms / problem.measured[two].time_ms)}",
                      *(_winner(problem, workers) for workers in SHOWN_WORKERS)])
    return (f"Least t_pr + t_s of every solver over all partitions tried, ms, one thread, and in brackets the partition that gave it: partitioner, its "
            f"effort or split, most bodies of a part, refiner (`{WORTH[1]}`; "
            f"{stored.origin(WORTH[0])}); then the fastest on two threads, and of the modelled {' and '.join(map(str, SHOWN_WORKERS))} workers, "
            "with its speed-up against the fastest on one:\n\n" +
            text.table(["", *partition_worth.NAMES.values(), "two threads", *(f"{workers} workers" for workers in SHOWN_WORKERS)], lines))


def _kind_cell(kind):
    parts = "one part" if kind.parts == 1 else f"{kind.parts} parts, {kind.interface_rows} interface rows"
    return f"{text.number(kind.cell.time_ms)} ({_partition(kind.cell)}: {parts})"


def semantic(stored):
    """Parts after the groups that a scene names against parts that are found."""
    found = partition_worth.kinds(need(stored.table(*WORTH), "semantic parts", "parts"))
    kinds = (partition_worth.WHOLE, partition_worth.RUNS, partition_worth.FOUND)
    lines = [[f"{scene.replace('_', ' ')}, {bodies} bodies, {rows} rows", partition_worth.NAMES[solver], *(_kind_cell(of_kind[kind]) for kind in kinds)]
             for ((scene, bodies, _), rows, solver), of_kind in found.items()]
    return (f"Least t_pr + t_s, ms, one thread, of parts after the groups of bodies that the scene names (`semantic`: whole, and cut into runs) and of all "
            f"parts that are found from the graph, each with its best size and refiner (`{WORTH[1]}`; {stored.origin(WORTH[0])}):\n\n" +
            text.table(["", "kernel", *kinds], lines))


def regret_of_auto(stored):
    """auto against the best cell of its grid."""
    found = regret.regrets(need(stored.table(*REGRET), "auto", "replay"))
    lines = [[f"{item.scene.replace('_', ' ')}, {item.solver}", item.best, *map(text.number, (item.best_ms, item.baseline_ms, item.auto_ms)),
              f"{100 * item.regret:+.0f} %", ", ".join(item.choices), "yes" if item.holds else "no"] for item in found]
    return (f"t_pr + t_s, ms, one thread ({stored.origin(REGRET[0])}); `auto` holds where it takes at most {1 + regret.MOST_REGRET:g} times what the "
            f"best cell takes and no more than {regret.BASELINE}. `{regret.ANY_KERNEL}` chooses the kernel too, against the cells of all kernels, whose replays are put at "
            f"the pace of `{regret.WHOLE}` in each. The time of choosing, once a scene, is left out:\n\n" +
            text.table(["", "best cell", "its time", regret.BASELINE, "auto", "regret", "auto chose", "holds"], lines))


BLOCKS = {"over_time": over_time, "worth": worth, "semantic": semantic, "regret": regret_of_auto}
