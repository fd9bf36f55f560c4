"""What the cost model of partitions is worth: parts made by it, and the partitioner auto, which chooses by it."""
from cleave_scripts.documents.stored import need
from cleave_scripts.measurements import objectives, regret
from cleave_scripts.table import text

OBJECTIVES = ("partition_objectives.csv", "scripts/partition_objectives")
REGRET = ("partition_regret.csv", "scripts/partition_regret")


def _gain(gain):
    return " / ".join(map(text.two_decimals, (gain.rows, gain.t_s, gain.total)))


def objectives_of_parts(stored):
    """Modelled time as the objective against the cut."""
    rows = need(stored.table(*OBJECTIVES), "objectives", "round")
    lines = [[f"{scene.replace('_', ' ')}, {solver}", *(_gain(gain) for gain in of_pair.values())]
             for (scene, solver), of_pair in objectives.gains(rows).items()]
    steps, rounds = (len({row[column] for row in rows}) for column in ("step", "round"))
    return (f"Modelled time as the objective over the cut: interface rows / t_s / t_pr + t_s, one thread, sums over {steps} "
            f"recorded steps of a scene, medians of {rounds} rounds (`{OBJECTIVES[1]}`; {stored.origin(OBJECTIVES[0])}):\n\n" +
            text.table(["", *(f"{cost} : {cut}" for cut, cost in objectives.PAIRS.items())], lines))


def regret_of_auto(stored):
    """auto against the best cell of its grid."""
    found = regret.regrets(need(stored.table(*REGRET), "auto", "replay"))
    lines = [[f"{item.scene.replace('_', ' ')}, {item.solver}", item.best,
              *map(text.number, (item.best_ms, item.baseline_ms, item.auto_ms)),
              f"{100 * item.regret:+.0f} %", ", ".join(item.choices), "yes" if item.holds else "no"] for item in found]
    return (f"t_pr + t_s, ms, one thread ({stored.origin(REGRET[0])}); `auto` holds where it takes at most "
            f"{1 + regret.MOST_REGRET:g} times what the best cell takes and no more than {regret.BASELINE}. "
            f"`{regret.ANY_KERNEL}` chooses the kernel too, against the cells of all kernels, whose replays are put at "
            f"the pace of `{regret.WHOLE}` in each. The time of choosing, once a scene, is left out:\n\n" +
            text.table(["", "best cell", "its time", regret.BASELINE, "auto", "regret", "auto chose", "holds"], lines))


BLOCKS = {"objectives": objectives_of_parts, "regret": regret_of_auto}
