"""Blocks of rows that may be averaged: those of one experiment and scene, measured under one setup."""
import dataclasses

import pandas

from cleave_scripts.figures import solver_labels
from cleave_scripts.results.about import options_about, setup_columns
from cleave_scripts.results.manifest import processor
from cleave_scripts.results.names import NO_PARTITIONER, said_parameters
from cleave_scripts.table.timing_table import NOT_A_PARAMETER

SCALING_FOLDER = "scaling"
SETUP = ("problem", "partition")  # the solver is in the label


@dataclasses.dataclass(eq=False)
class Block:
    """Rows of one experiment and one scene that may be averaged; rows carry the label of their solver."""

    experiment: object
    scene: str
    setup: frozenset  # of (option, value)
    rows: pandas.DataFrame

    @property
    def threads(self):
        known = self.rows["threads"].dropna() if "threads" in self.rows else ()
        return int(known.iloc[0]) if len(known) else None

    @property
    def label(self):
        """Of a block of one solver: its name with the options that make it another."""
        return self.rows["label"].iloc[0]

    @property
    def is_default(self):
        """Of a block of one solver: whether it is as the program has it."""
        return self.label == self.rows["solver"].iloc[0]

    @property
    def ok(self):
        return self.rows[self.rows["status"] == "ok"]

    @property
    def is_scaling(self):
        return SCALING_FOLDER in self.experiment.name.split("/")

    @property
    def is_motion(self):
        """Run for pictures: its times are of other partitions, once each."""
        return self.experiment.manifest.get("options", {}).get("record-motion", "False").lower() == "true"

    def of_solver(self, solver):
        """The same block with the rows of one solver that works on parts, or None."""
        rows = self.rows[(self.rows["solver"] == solver) & (self.rows["partitioner"] != NO_PARTITIONER)]
        return dataclasses.replace(self, rows=rows) if len(rows) else None


def make_blocks(tree):
    """Splits every experiment by scene and by the columns that may not be mixed in a mean."""
    return [block for experiment in tree.experiments for block in _blocks_of(experiment)]


def _blocks_of(experiment):
    rows = solver_labels.with_labels(experiment.rows, experiment.manifest)
    partition = setup_columns(experiment.manifest, about=("partition",))
    columns = ("threads", *setup_columns(experiment.manifest, about=SETUP), "bodies")
    keys = pandas.DataFrame({
        column: _without_said(rows, column) if column in partition else rows[column]
        for column in columns if column in rows
    }, rows.index)
    together = rows.groupby([rows["scene"], *(keys[column] for column in keys)], dropna=False, sort=False)
    for places in together.groups.values():
        part = rows.loc[places]
        yield Block(experiment, part["scene"].iloc[0], _setup(experiment.manifest, keys.loc[places]), part)


def _without_said(rows, column):
    """A parameter; where a name says its value, or an algorithm has no such parameter, it is that of the other rows."""
    parameter = column.replace("_", "-")
    said = [any(parameter in said_parameters(name) for name in names) for names in zip(rows["partitioner"], rows["refiner"])]
    applies = ~pandas.Series(said, rows.index) & rows[column].notna() & (rows[column] != "-")
    return rows[column].where(applies, rows.loc[applies, column].iloc[0] if applies.any() else "-")


def _setup(manifest, keys):
    """(option or column, value) of all that has to be the same in another block of the same setup, the processor too. What
    nothing that ran has, such as parts where nobody splits, is left out."""
    about = options_about(manifest)
    options = ({"machine": processor(manifest)} |
               {name: str(value) for name, value in manifest.get("options", {}).items() if about.get(name) in SETUP})
    columns = {column: str(keys[column].iloc[0]) for column in keys if column != "threads"}
    return frozenset((options | {column: value for column, value in columns.items() if value != NOT_A_PARAMETER}).items())
