"""The claims of the paper that can be checked, from its partitioners, refiners and scenes."""
import functools

import numpy

from cleave_scripts.figures.claim import (HALF, Claim, LeastOf, cell_name, every_gain, exponent_difference, gain,
                                          gain_of_lowest, lowest)
from cleave_scripts.results.names import title
from cleave_scripts.results.paper import PARTITIONERS, REFINERS, SCENES

SAME_EXPONENT = 0.1  # growth exponents this close are the same
MUCH_FASTER = 5.0  # what 'greatly improved' has to mean
ROCKS = "rocks"
LONGEST_LOG_TOWER = "log_tower, longest run"  # peaks are looked for where most steps were measured
KARGER_RIVALS = ("mindp", "mix")


def karger_place(scene):
    """Where karger ran beside its rivals: the paper's experiment is without it."""
    return f"{scene}, with karger"


def grid(scene, partitioners=PARTITIONERS, refiners=REFINERS):
    return tuple((scene, partitioner, refiner) for partitioner in partitioners for refiner in refiners)


def others(*names):
    return tuple(name for name in PARTITIONERS if name not in names)


def fastest_partitioners():
    for scene in SCENES:
        good, rest = grid(scene, ("mindp", "mix"), ("none",)), grid(scene, others("mindp", "mix"), ("none",))
        yield Claim("mindp and mix are the fastest partitioners in every example", title(scene),
                    "lowest of maxdp, bfs, mr + none", good + rest, every_gain(good, rest))


def log_tower_gains():
    for scene, partitioner, refiner, said in (("log_tower", "mindp", "fm", 31),
                                              ("log_tower", "mindp", "kl", 12), ("log_tower", "mix", "fm",
                                                                                 31)):
        good, base = (scene, partitioner, refiner), (scene, partitioner, "none")
        yield Claim("FM and KL reduce t_s on Log Tower by about 31 % and 12 %",
                    f"{cell_name(good)}, said {said} %",
                    cell_name(base), (good, base),
                    gain(good, base),
                    share_of_paper=HALF)


def rock_pile_gains():
    for scene, said in (("rock_pile", 46), ("large_rock_pile", 35)):
        good, base = (scene, "mix", "fm"), (scene, "mindp", "none")
        yield Claim("mix + fm reduces t_s by 46 % and 35 % on the rock piles",
                    f"{title(scene)}, said {said} %",
                    cell_name(base), (good, base),
                    gain(good, base),
                    share_of_paper=HALF)


def size_independence(sizes):
    """sizes: numbers of rocks that were run; without them the rows stay open."""
    for partitioner in ("mindp", "mix"):
        for refiner in ("kl", "fm"):
            good, base = (
                [(f"{ROCKS} {size}", partitioner, name) for size in sizes] for name in (refiner, "none"))
            yield Claim("gains do not depend on the size of the problem",
                        f"{partitioner}: growth exponent of none less that of {refiner}",
                        f"{partitioner} + none",
                        tuple(good + base),
                        exponent_difference(sizes, good, base),
                        least=-SAME_EXPONENT,
                        most=SAME_EXPONENT,
                        unit="",
                        paper_cells=False)


def consistent_refiners():
    for scene in SCENES:
        pairs = [((scene, p, r), (scene, p, "none")) for p in PARTITIONERS for r in ("kl", "fm")]
        yield Claim("FM and KL reduce t_s consistently", f"{title(scene)}: least gain of the ten",
                    "each partitioner + none", grid(scene), LeastOf(gain(*pair) for pair in pairs))


def chain_drop():
    text, best = "Chain Drop gains little, and bfs + fm is best there", ("chain_drop", "bfs", "fm")
    rest = tuple(cell for cell in grid("chain_drop") if cell != best)
    yield Claim(text, "bfs + fm against the best other cell", f"lowest of the other {len(rest)}", (best, *rest),
                every_gain((best,), rest))

    def margin(value):
        gains = {scene: 1 - lowest(value, grid(scene)) / value((scene, "mindp", "none")) for scene in SCENES}
        return functools.reduce(numpy.minimum, [gains[scene] for scene in SCENES[1:]]) - gains["chain_drop"]

    yield Claim(text, "least gain of the best cell elsewhere, less that on Chain Drop", "mindp + none",
                tuple(cell for scene in SCENES for cell in grid(scene)), margin)


def peaks():
    for refiner in ("kl", "fm"):
        good, base = (LONGEST_LOG_TOWER, "mindp", refiner), (LONGEST_LOG_TOWER, "mindp", "none")
        yield Claim("refinement lowers the peaks on Log Tower",
                    cell_name(good),
                    cell_name(base), (good, base),
                    gain(good, base),
                    statistic="peak",
                    paper_cells=False)


def mix_lowest():
    for scene in SCENES:
        good, rest = grid(scene, ("mix",)), grid(scene, others("mix"))
        yield Claim("mix has the lowest solver time everywhere", title(scene), "lowest cell without mix",
                    good + rest, gain_of_lowest(good, rest))


def partition_times(paper):
    for scene in SCENES:
        cells = grid(scene)

        def figure(value, cells=cells):
            return numpy.median(numpy.stack([paper[cell][1] / numpy.asarray(value(cell)) for cell in cells]),
                                axis=0)

        yield Claim("t_pr can be improved greatly by careful code",
                    f"{title(scene)}: the paper's t_pr over ours",
                    f"median of the {len(cells)} cells",
                    cells,
                    figure,
                    least=MUCH_FASTER,
                    unit="x",
                    column="t_pr_ms",
                    paper_cells=False,
                    sizes_decide=False)


def karger():
    for scene in SCENES:
        place = karger_place(scene)
        good, rest = grid(place, KARGER_RIVALS), grid(place, ("karger",))
        yield Claim("the Karger partitioner is not competitive",
                    title(scene),
                    "lowest cell of karger",
                    good + rest,
                    gain_of_lowest(good, rest),
                    paper_cells=False)


def mass_ratio(columns):
    scene = "large_rock_pile"
    good, rest = grid(scene, ("mr",), ("none",)), grid(scene, others("mr"), ("none",))
    conditions = sorted(
        name for name in columns if name.startswith("part_condition")) or ["part_condition_max"]
    for column in ("part_mass_ratio_max", *conditions):
        yield Claim("mr avoids badly conditioned subsystems",
                    f"{title(scene)}: {column}, largest over the steps",
                    "lowest of the other four + none",
                    good + rest,
                    gain_of_lowest(good, rest),
                    least=HALF,
                    column=column,
                    statistic="most",
                    paper_cells=False,
                    sizes_decide=False)


def all_claims(paper, sizes, columns):
    return [
        *fastest_partitioners(), *log_tower_gains(), *rock_pile_gains(), *size_independence(sizes),
        *consistent_refiners(), *chain_drop(), *peaks(), *mix_lowest(), *partition_times(paper), *karger(),
        *mass_ratio(columns)
    ]
