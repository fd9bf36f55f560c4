"""What is stored: a line each set of results, with what made it."""
import re

from cleave_scripts.results.manifest import load_manifest
from cleave_scripts.table import text

# File or directory below results/: what it holds, and the command that makes it.
SETS = {
    "full": ("the matrix: the paper's scenes and combinations; Table 1", "scripts/reproduce --measure-every 10"),
    "report": (
        "what the report draws besides: rock piles of growing size, every step of Log Tower, one thread, "
        "other kernels and solvers",
        "scripts/report_runs --measure-every 25"),
    "report/verdicts.csv": ("the paper's claims, judged", "scripts/report"),
    "ladder/ladder.csv": ("the stability ladder, quick values, every solver", "scripts/ladder"),
    "ladder/ladder_full_exact.csv": ("all its values by `exact`", "scripts/ladder --full --solver exact"),
    "extremes.csv": (
        "factorisations of the interior point at extreme stiffness and mass ratios, a row a step",
        "scripts/extremes --seeds 1"),
    "karger.csv": (
        "random contraction after Karger with 1 to 10000 trials against `mindp+fm` and `mix+fm`",
        "scripts/karger"),
    "partition_over_time.csv": (
        "every scene step by step under every rule of `--repartition`",
        "scripts/partition_over_time"),
    "partition_worth.csv": (
        "recorded steps by every kernel with many partitions, on one thread and on two",
        "scripts/partition_worth"),
    "partition_worth.png": ("the picture of it", "scripts/partition_worth"),
    "partition_regret.csv": (
        "the partitioner `auto` against every cell of a grid, in turn",
        "scripts/partition_regret --rounds 4"),
    "partition_objectives.csv": (
        "parts that are to take little time against parts that are to cut few rows, in turn",
        "scripts/partition_objectives"),
    "tradeoff.csv": (
        "recorded steps by every solver, those that iterate to residuals of 1e-1 to 1e-8",
        "scripts/tradeoff"),
    "price_of_accuracy.png": ("the picture of six of these steps", "scripts/tradeoff"),
    "time_to_accuracy.png": ("the same of all that are drawn", "scripts/tradeoff"),
    "crossover.png": ("where `exact` overtakes those that iterate", "scripts/tradeoff"),
    "accuracy_profile.png": ("how often each of these solvers is how near to the fastest", "scripts/tradeoff"),
    "tradeoff_partitions.csv": (
        "recorded steps by direct and iterative solvers on parts, with many partitions",
        "scripts/tradeoff"),
    "tradeoff_motion.csv": ("scenes that one solver alone has moved", "scripts/tradeoff"),
    "tradeoff_motion.png": ("the picture of it", "scripts/tradeoff"),
    "model_savings.csv": ("the scenes with every row and with those that can matter, in turn", "scripts/model_savings"),
    "friction_motion.csv": ("the scenes, each moved under every friction model", "scripts/friction_models"),
    "friction_velocities.csv": (
        "recorded steps under `box`, `box-converged` and `cone`, held against Coulomb's law",
        "scripts/friction_models"),
    "friction_bounds.csv": (
        "the bounds of the box by the sweeps that predict them, and what a sweep costs",
        "scripts/friction_models"),
    "friction_forms.csv": (
        "from which coefficient on a block holds on a slope, and how far one that slides lifts off, beside closed forms",
        "scripts/friction_forms"),
    "friction_cost.csv": (
        "steps under the cone and under Coulomb's law beside the same steps under the box, in turn",
        "scripts/friction_cost"),
    "coulomb_peers.csv": (
        "recorded steps under Coulomb's law, by `exact` and by Siconos's solvers",
        "scripts/coulomb_peers"),
    "peer_times.csv": (
        "recorded steps of settled piles by `exact`, by solvers of Bullet, DART and Ipopt, and by MuJoCo, in turn",
        "scripts/peers"),
    "campaign_costs.csv": (
        "what a campaign of very many cells costs, and that of the paper besides its solves",
        "scripts/campaign_costs --paper out/report/paper"),
    "hidden_choices.csv": (
        "what the paper leaves open: cuts under every choice, times under some",
        "scripts/hidden_choices"),
    "hidden_choices_claims.csv": (
        "in how many of these settings each claim of the paper holds",
        "scripts/hidden_choices"),
    "hidden_choices_fit.csv": (
        "how like the paper's Table 1 the cells of each setting are ranked",
        "scripts/hidden_choices"),
    "verdict_map.png": ("the picture of the claims", "scripts/hidden_choices"),
    "cold_starts.csv": (
        "factorisations of `exact` from zero impulses and from those of the step before",
        "scripts/cold_starts"),
    "solver_benchmark.json": (
        "exact solves against Gauss-Seidel, own factorisation against CHOLMOD",
        "scripts/benchmark_solvers"),
    "dense_benchmark.json": (
        "the dense Cholesky factorisation against the processor's peak and OpenBLAS",
        "scripts/benchmark_dense"),
    "busy_machine.csv": ("a step on two threads while other programs keep the cores busy", "scripts/busy_machine"),
    "idle_cost.csv": ("steps on two threads of an idle machine, with threads that go to sleep and with threads that never do",
                      "scripts/idle_cost"),
    "partition_benchmark.json": (
        "partitioners and refiners, METIS and SCOTCH among them, on recorded steps and synthetic piles",
        "scripts/benchmark_partitioners"),
    "two_threads.csv": ("recorded steps with one and with two threads, in turn", "scripts/two_threads"),
    "compare_builds.csv": (
        "the same steps by the last build whose solver was serial and by today's, in turn, one thread",
        "scripts/compare_builds"),
    "modelled_workers.csv": (
        "recorded steps with one and with two threads, in turn, and what the model of the first says",
        "scripts/modelled_workers"),
    "running_simulation.csv": (
        "steps of running simulations with and without `--session`, in sweeps of Gauss-Seidel",
        "scripts/running_simulation"),
    "large_scenes.csv": ("a step of rock piles and silos of up to 100000 bodies", "scripts/large_scenes"),
    "elimination_orders.csv": (
        "arithmetic of a factorisation in every order of elimination",
        "scripts/elimination_orders"),
    "ablation.csv": ("interface rows under the open choices of the method", "scripts/ablation"),
    "figures": ("the pictures of the README", "scripts/readme_figures"),
}


def command_of(stored, name):
    """What made it as it is stored, less where it went; files of a directory that are sets of their own do not say."""
    known = stored.provenance()
    entry = known.get(name) or next((entry for file, entry in known.items()
                                     if file.startswith(f"{name}/") and file not in SETS), None)
    made_by = entry and entry.get("command") or SETS[name][1]
    return re.sub(r" --out \S+", "", made_by)


def _minutes(stored, name):
    manifests = [load_manifest(path.parent) for path in sorted((stored.root / name).rglob("manifest.json"))]
    seconds = sum(manifest["result"]["wall_s"] for manifest in manifests) or stored.provenance().get(name, {}).get(
        "seconds")
    return "-" if not seconds else f"{seconds / 60:.1f} min"


def reference_sets(stored):
    there = [name for name, (_, command) in SETS.items() if stored.has(name, command)]
    lines = [[f"`{name}`", SETS[name][0], f"`{command_of(stored, name)}`", _minutes(stored, name), stored.origin(name)]
             for name in there]
    missing = [f"`{name}` (`{command}`)" for name, (_, command) in SETS.items() if name not in there]
    lines = text.table(["set", "what", "made by", "took", "on"], lines)
    return lines + (f"\n\nNot stored yet: {text.listed(missing)}." if missing else "")


BLOCKS = {"reference_sets": reference_sets}
