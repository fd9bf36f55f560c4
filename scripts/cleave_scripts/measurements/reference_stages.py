"""The stages of scripts/reference: what each runs, how long that takes, and which of its files are kept in results/."""
import dataclasses

REPORT = "report"  # one directory for all that scripts/report draws
REPORT_RUNS = ("scaling", *(f"report/{name}" for name in ("one_thread", "schur_bodies", "solvers", "every_step", "karger")))
RUN_FILES = ("manifest.json", "steps.csv")


@dataclasses.dataclass(frozen=True)
class Stage:
    name: str
    command: tuple  # a script and its options; {out} is where the stage writes, {report} what the report is drawn from
    minutes: float
    directory: str = ""  # below the reference directory; the name where it is empty
    runs: tuple = ()  # (campaign, or the first part of its labels too; where to below results/)
    files: tuple = ()  # (file or pattern, where to below results/; a directory ends in /)
    resumes: bool = False  # whether a start goes on where the one before was stopped: campaigns do

    @property
    def place(self):
        return self.directory or self.name


STAGES = (
    Stage("matrix", ("reproduce", "--measure-every", "10", "--out", "{out}"), 11, REPORT,
          runs=(("paper", "full"),), resumes=True),
    Stage("report_runs", ("report_runs", "--measure-every", "25", "--out", "{out}"), 4, REPORT,
          runs=tuple((name, f"report/{name.removeprefix('report/')}") for name in REPORT_RUNS), resumes=True),
    Stage("ladder", ("ladder", "--out", "{out}"), 4, REPORT, files=(("ladder.csv", "ladder/ladder.csv"),), resumes=True),
    Stage("ladder_full", ("ladder", "--full", "--solver", "exact", "--out", "{out}"), 2,
          files=(("ladder.csv", "ladder/ladder_full_exact.csv"),), resumes=True),
    Stage("solver_benchmark", ("benchmark_solvers", "--out", "{out}"), 3,
          files=(("solver_benchmark.json", "solver_benchmark.json"),)),
    Stage("dense_benchmark", ("benchmark_dense", "--out", "{out}"), 3,
          files=(("dense_benchmark.json", "dense_benchmark.json"),)),
    Stage("busy_machine", ("busy_machine", "--out", "{out}"), 1, files=(("busy_machine.csv", "busy_machine.csv"),)),
    Stage("idle_cost", ("idle_cost", "--out", "{out}"), 1, files=(("idle_cost.csv", "idle_cost.csv"),)),
    Stage("partition_benchmark", ("benchmark_partitioners", "--out", "{out}"), 15,
          files=(("partition_benchmark.json", "partition_benchmark.json"),)),
    Stage("karger", ("karger", "--out", "{out}"), 3, files=(("karger.csv", "karger.csv"),)),
    Stage("partition_over_time", ("partition_over_time", "--out", "{out}"), 3,
          files=(("partition_over_time.csv", "partition_over_time.csv"),)),
    Stage("partition_worth", ("partition_worth", "--out", "{out}"), 10,
          files=tuple((file, file) for file in ("partition_worth.csv", "partition_worth.png"))),
    Stage("partition_regret", ("partition_regret", "--rounds", "4", "--out", "{out}"), 21,
          files=(("partition_regret.csv", "partition_regret.csv"),)),
    Stage("partition_objectives", ("partition_objectives", "--out", "{out}"), 6,
          files=(("partition_objectives.csv", "partition_objectives.csv"),)),
    Stage("two_threads", ("two_threads", "--out", "{out}"), 50, files=(("two_threads.csv", "two_threads.csv"),)),
    Stage("compare_builds", ("compare_builds", "--out", "{out}"), 11, files=(("compare_builds.csv", "compare_builds.csv"),)),
    Stage("modelled_workers", ("modelled_workers", "--out", "{out}"), 5,
          files=(("modelled_workers.csv", "modelled_workers.csv"),)),
    Stage("running_simulation", ("running_simulation", "--out", "{out}"), 3,
          files=(("running_simulation.csv", "running_simulation.csv"),)),
    Stage("large_scenes", ("large_scenes", "--out", "{out}"), 40, files=(("large_scenes.csv", "large_scenes.csv"),)),
    Stage("elimination_orders", ("elimination_orders", "--out", "{out}"), 1,
          files=(("elimination_orders.csv", "elimination_orders.csv"),)),
    Stage("cold_starts", ("cold_starts", "--out", "{out}"), 1, files=(("cold_starts.csv", "cold_starts.csv"),)),
    Stage("ablation", ("ablation", "--out", "{out}"), 3, files=(("ablation.csv", "ablation.csv"),)),
    Stage("extremes", ("extremes", "--seeds", "1", "--out", "{out}"), 12, files=(("extremes.csv", "extremes.csv"),),
          resumes=True),
    Stage("tradeoff", ("tradeoff", "--out", "{out}"), 25,
          files=tuple((file, file)
                      for file in ("tradeoff.csv", "tradeoff_partitions.csv", "tradeoff_motion.csv", "price_of_accuracy.png",
                                   "time_to_accuracy.png", "crossover.png", "accuracy_profile.png", "tradeoff_motion.png"))),
    Stage("model_savings", ("model_savings", "--out", "{out}"), 3, files=(("model_savings.csv", "model_savings.csv"),)),
    Stage("friction_models", ("friction_models", "--out", "{out}"), 40,
          files=tuple((file, file) for file in ("friction_motion.csv", "friction_velocities.csv", "friction_bounds.csv"))),
    Stage("friction_forms", ("friction_forms", "--out", "{out}"), 1, files=(("friction_forms.csv", "friction_forms.csv"),)),
    Stage("friction_cost", ("friction_cost", "--out", "{out}"), 20, files=(("friction_cost.csv", "friction_cost.csv"),)),
    Stage("coulomb_peers", ("coulomb_peers", "--out", "{out}"), 10, files=(("coulomb_peers.csv", "coulomb_peers.csv"),)),
    Stage("peers", ("peers", "--out", "{out}"), 10, files=(("peer_times.csv", "peer_times.csv"),)),
    Stage("campaign_costs", ("campaign_costs", "--paper", "{report}/paper", "--out", "{out}"), 12,
          files=(("campaign_costs.csv", "campaign_costs.csv"),), resumes=True),
    Stage("hidden_choices", ("hidden_choices", "--out", "{out}", "--report", "{report}"), 50,
          files=tuple((file, file) for file in ("hidden_choices.csv", "hidden_choices_claims.csv", "hidden_choices_fit.csv",
                                                "verdict_map.png")),
          resumes=True),
    Stage("pictures", ("render_figures", "{report}"), 5, REPORT),
    Stage("report", ("report", "{report}"), 1, REPORT, files=(("**/verdicts.csv", "report/verdicts.csv"),)),
    Stage("figures", ("readme_figures", "{report}", "--out", "{out}"), 2, files=(("*.png", "figures/"),)),
)
