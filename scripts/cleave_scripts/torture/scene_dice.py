"""Random scenes and options, small and as extreme as the program allows."""
ROCKS = ("box", "sphere", "clump", "convex")


def _power(dice, least, most):
    return f"{10**dice.uniform(least, most):.6g}"


def _pile(dice):
    masses = ",".join(_power(dice, -1, 6) for _ in range(dice.choice([1, 2, 3])))
    return ["--bodies", dice.randrange(1, 25), "--mass", masses]


def _rocks(dice):
    return [*_pile(dice), "--rock-shape", dice.choice(ROCKS), "--depth", dice.randrange(1, 8)]


def _box_column(dice):
    words = ["--boxes", dice.randrange(1, 8)]
    if dice.random() < 0.3:
        words += ["--overlap-m", dice.choice(["0", "1e-8", "1e-6"]), "--layer-m", dice.choice(["0", "1e-4", "0.01"])]
    return words + (["--offset-m", _power(dice, -6, -1)] if dice.random() < 0.3 else [])


SCENES = {
    "rock_pile": _rocks,
    "large_rock_pile": _rocks,
    "silo": _pile,
    "chain_drop": lambda dice: ["--links", dice.randrange(1, 25), "--bob-mass", _power(dice, -3, 6)],
    "log_tower": lambda dice: ["--layers", dice.randrange(1, 5), "--logs", dice.randrange(2, 5), "--log-shape",
                               dice.choice(["capsule", "box", "cylinder"])],
    "crane": lambda dice: ["--links", dice.randrange(1, 25), "--mass-ratio", _power(dice, 0, 9), "--slew",
                           round(dice.uniform(0, 10), 3)],
    "mixed_site": lambda dice: ["--links", dice.randrange(50, 70), "--rings", 1, "--mass", _power(dice, -1, 6)],
    "ladder_stack": lambda dice: [*_box_column(dice), "--copies", dice.randrange(1, 5)],
    "ladder_heavy_top": lambda dice: [*_box_column(dice), "--mass-ratio", _power(dice, 0, 9)],
    "ladder_alternating": lambda dice: [*_box_column(dice), "--mass-ratio", _power(dice, 0, 9)],
    "ladder_incline": lambda dice: [*_box_column(dice), "--angle", round(dice.uniform(0, 80), 3)],
    "ladder_chain": lambda dice: ["--links", dice.randrange(1, 15), "--mass-ratio", _power(dice, 0, 9), "--angle",
                                  round(dice.uniform(0, 80), 3)],
    "ladder_loop": lambda dice: ["--links", dice.randrange(3, 15)],
    "ladder_free": lambda dice: ["--boxes", dice.randrange(1, 5)],
}


def world(dice):
    """Words that say what is simulated."""
    scene = dice.choice(sorted(SCENES))
    words = ["--scene", scene, *SCENES[scene](dice), "--seed", dice.randrange(1, 10**6)]
    for option, value in (("--dt", _power(dice, -4, -1)),
                          ("--cfm", dice.choice([_power(dice, -14, -3), _power(dice, -14, -3), "0"])),
                          ("--erp", round(dice.random(), 3)),
                          ("--gravity", round(dice.uniform(-20, 40), 3)),
                          ("--contact-cap", dice.randrange(1, 17)),
                          ("--match-tolerance", _power(dice, -3, 1))):
        if dice.random() < 0.4:
            words += [option, value]
    return words + _friction(dice)


def _friction(dice):
    model = dice.choice(["box", "box", "box-converged", "none", "constant"])
    if model.startswith("box"):
        return ["--friction", model, "--mu", dice.choice(["0", f"{dice.uniform(0, 2):.4f}", "2"])]
    return ["--friction", model, *(["--friction-force-n", _power(dice, -3, 5)] if model == "constant" else [])]


PARTITIONERS = ("mindp", "maxdp", "bfs", "mr", "mix")
REFINERS = ("none", "kl", "fm")
NAMED = ("dense", "monolithic", "schur", "exact", "pgs")
STRATEGIES = ("pivot", "newton", "interior-point", "auto")
KERNELS = ("monolithic", "schur-rows", "schur-bodies", "dense", "auto")


def combinations(dice):
    """Words that say who splits and who solves; those that the choice has no use for are refused by the program."""
    pairs = [*(f"{strategy}:{kernel}" for strategy in STRATEGIES for kernel in KERNELS), "alternate:schur-rows"]
    most = dice.choice([1, 2, 3, 8, 25])
    chosen = [f"{name}@max-bodies={most}" for name in dice.sample(PARTITIONERS, dice.choice([1, 2, 5]))]
    words = ["--partitioner", ",".join(chosen),
             "--refiner", ",".join(dice.sample(REFINERS, dice.choice([1, 3]))),
             "--solver", ",".join([*dice.sample(NAMED, dice.choice([1, 2])), *dice.sample(pairs, dice.choice([0, 1, 3]))]),
             "--threads", dice.choice([1, 2]), "--repeats", 1]
    return words + (["--skip-small-islands"] if dice.random() < 0.1 else [])


def advance(dice):
    """Parameters that also the solver has which moves the world: whoever shall make the same step needs the same."""
    return ["--reuse-analysis"] if dice.random() < 0.1 else []
