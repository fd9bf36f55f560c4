"""What every figure draws from."""
import dataclasses

from cleave_scripts.figures import looks
from cleave_scripts.figures.blocks import make_blocks
from cleave_scripts.figures.choose import main_blocks
from cleave_scripts.figures.tree import read_tree
from cleave_scripts.results.command_line import counted
from cleave_scripts.results.names import NO_PARTITIONER


@dataclasses.dataclass
class Data:
    tree: object
    solver: str  # that the paper's figures are about
    blocks: list
    main: dict  # scene -> blocks of the paper's experiment
    messages: list


def load(directory, solver):
    tree = read_tree(directory)
    blocks = make_blocks(tree)
    looks.meet([experiment.rows for experiment in tree.experiments])
    main, notes = main_blocks(blocks, solver)
    return Data(tree, solver, blocks, main, [*tree.messages, *notes, *_failures(tree)])


def _failures(tree):
    """One line an experiment about rows that are not ok."""
    for experiment in tree.experiments:
        failed = experiment.rows[experiment.rows["status"] != "ok"]
        if len(failed):
            groups = failed.groupby(["status", "solver", "partitioner", "refiner"]).size()
            texts = [
                f"{count} {status} by {' '.join(name for name in names if name != NO_PARTITIONER)}"
                for (status, *names), count in groups.items()
            ]
            yield (f"{experiment.name}: {counted(len(failed), 'row')} of {len(experiment.rows)} not ok: "
                   f"{', '.join(texts)}")
