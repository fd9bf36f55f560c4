"""Algorithms and parameters that the paper does not have go through tables, figures, report and checks by themselves."""
import pathlib
import tempfile
import unittest

from report_data import manifest, rows_of, whole_system, write_claims, write_ladder, write_motions, write_run, write_tradeoff
from synthetic import matrix, run_script, write_manifest, write_steps

from cleave_scripts.figures import data, looks, solver_groups, style, trade_off
from cleave_scripts.figures.registry import FIGURES
from cleave_scripts.figures.tables import scene_tables
from cleave_scripts.results.about import setup_columns, solver_parameters, strategy_and_kernel
from cleave_scripts.results.names import base_name, in_order, said_parameters
from cleave_scripts.results.paper import COMBINATIONS, PARTITIONERS, REFINERS, SCENES

NEWCOMERS = ("stripes@width=5", "metis-kway", f"{PARTITIONERS[0]}@max-bodies=50", "file@1f2e3d4c")
REFINER = "swap"
BASELINE = "relax@sweeps=30"


def algorithm(kind, text, parameters=None, defaults=None):
    return {"kind": kind, "text": text, "name": base_name(text), "parameters": parameters or {},
            "defaults": defaults or parameters or {}}


def newer_manifest(scene, algorithms, **options):
    """A manifest that says itself what its options, columns and algorithms change."""
    options = {"scene": scene, "threads": 1, "steps": 500, "skip": 0, "cfm": 1e-5, **options}
    return manifest(scene) | {
        "options": options,
        "option_about": {name: "problem" if name == "cfm" else "bookkeeping" for name in options},
        "algorithms": algorithms,
        "columns": [{"name": name, "about": about} for name, about in
                    (("t_s_ms", "measured"), ("cfm", "problem"), ("max_bodies", "partition"), ("width", "partition"))],
    }


def rows_with_newcomers(scene):
    """The paper's rows, those of the newcomers, and those of a baseline that is not exact."""
    def parameters(row):
        name = row["partitioner"]
        return row | {"max_bodies": 50 if "50" in name else "-" if name in NEWCOMERS else 25,
                      "width": 5 if "width" in name else "-"}

    rows = rows_of(scene, (*PARTITIONERS, *NEWCOMERS), (*REFINERS, REFINER))
    baseline = rows_of(scene, ("-",), ("-",), solver=BASELINE, kernel=BASELINE, t_s_ms=1, residual_m_per_s=1e-3,
                       status="not_converged")
    return [parameters(row) for row in rows + baseline]


def write_newcomers(directory, scenes=SCENES):
    algorithms = [algorithm("solver", "schur", {"strategy": "pivot", "kernel": "schur-rows"}),
                  algorithm("solver", BASELINE, {"sweeps": "30"}, {"sweeps": "5"})]
    for scene in scenes:
        write_steps(directory / scene, rows_with_newcomers(scene))
        write_manifest(directory / scene, **newer_manifest(scene, algorithms))


class Scratch(unittest.TestCase):

    def setUp(self):
        scratch = tempfile.TemporaryDirectory()
        self.addCleanup(scratch.cleanup)
        self.directory = pathlib.Path(scratch.name)
        self.addCleanup(looks.meet, [])
        self.addCleanup(style.pyplot.close, "all")

    def run_it(self, name, *arguments, code=0):
        result = run_script(name, self.directory, *arguments)
        self.assertEqual(result.returncode, code, result.stdout + result.stderr)
        self.assertNotIn("Traceback", result.stderr)
        return result


class NewcomersTest(Scratch):

    def test_table_1_has_their_rows_in_every_format_and_parameters_in_names_do_not_mix(self):
        write_newcomers(self.directory)
        for format in ("text", "csv", "markdown", "latex"):
            lines = self.run_it("table1", "--format", format).stdout.splitlines()
            for name in NEWCOMERS:
                self.assertTrue(any(name in line and REFINER in line for line in lines), (format, name))
        lengths = {len(line.rstrip("!‡")) for line in self.run_it("table1").stdout.splitlines()
                   if line.startswith((*NEWCOMERS, *PARTITIONERS))}
        self.assertEqual(len(lengths), 1)

    def test_every_figure_is_drawn_and_every_name_has_a_colour_of_its_own(self):
        write_newcomers(self.directory, ["log_tower", "rock_pile"])
        write_ladder(self.directory)
        write_tradeoff(self.directory)
        write_motions(self.directory)
        write_claims(self.directory)
        for size in (50, 100):
            rows = rows_of("rock_pile", (PARTITIONERS[0], *NEWCOMERS), (REFINERS[0], REFINER), bodies=size, t_s_ms=size)
            write_run(self.directory / "scaling" / str(size), rows, bodies=size)
        rows = rows_of("rock_pile", t_s_ms=3, solver="pivot:later", kernel="later", max_bodies=25, width="-")
        write_steps(self.directory / "kernel", rows)
        write_manifest(self.directory / "kernel", **newer_manifest("rock_pile", []))
        loaded = data.load(self.directory, "schur")
        for figure in FIGURES:
            drawn, _ = figure.draw(loaded)
            drawn.draw_without_rendering()
            for legend in drawn.legends:
                box, whole = legend.get_window_extent(), drawn.bbox
                self.assertTrue(whole.x0 <= box.x0 and box.x1 <= whole.x1, f"{figure.name}: the legend is cut")
        names = (*PARTITIONERS, "-", *NEWCOMERS)
        self.assertEqual(len({looks.color(name) for name in names}), len(names))
        self.assertEqual(len({looks.solver_look(name)["color"] for name in ("schur", BASELINE)}), 2)
        for refiners in ("linestyle", "marker"):
            self.assertEqual(len({looks.line_look(names[0], refiner)[refiners] for refiner in (*REFINERS, REFINER)}), 4)

    def test_rows_of_all_combinations_are_one_block_whose_means_are_beside_each_other(self):
        write_newcomers(self.directory, ["rock_pile"])
        loaded = data.load(self.directory, "schur")
        block, = loaded.blocks
        self.assertEqual(set(block.rows["label"]), {"schur", "relax, 30 sweeps"})
        tables, faults = scene_tables(loaded)
        self.assertEqual(faults, [])
        self.assertEqual(len(tables[0].cells), (len(PARTITIONERS) + len(NEWCOMERS)) * (len(REFINERS) + 1))

    def test_the_report_has_them(self):
        write_newcomers(self.directory, ["log_tower", "rock_pile"])
        result = self.run_it("report")
        page = (self.directory / "report.html").read_text(encoding="utf-8")
        for name in (*NEWCOMERS, "relax, 30 sweeps"):
            self.assertTrue(name in page or name.partition(",")[0] in page, name)
        self.assertIn("t_pr can be improved greatly by careful code", page.replace("<i>t</i><sub>pr</sub>", "t_pr"))
        self.assertNotIn("Warning", result.stderr)

    def test_a_run_without_any_of_the_papers_partitioners_still_has_a_table_and_figures(self):
        rows = rows_of("log_tower", ("metis-kway",), (REFINER,), t_s_ms=3)
        write_run(self.directory / "log_tower", rows)
        loaded = data.load(self.directory, "schur")
        for name in ("figure3", "figure5", "interface_cost", "stages"):
            next(figure for figure in FIGURES if figure.name == name).draw(loaded)
        table, = scene_tables(loaded)[0]
        self.assertEqual([(cell.partitioner, cell.refiner) for cell in table.cells], [("metis-kway", REFINER)])
        self.run_it("report")

    def test_two_values_of_a_parameter_that_no_name_says_are_not_averaged(self):
        for value in (25, 50):
            rows = [row | {"max_bodies": value} for row in rows_of("rock_pile", steps=(9, 19) if value == 25 else (29,))]
            write_steps(self.directory / str(value), rows)
            write_manifest(self.directory / str(value), **newer_manifest("rock_pile", []))
        self.assertIn("mix max_bodies 25, 50; choose one", self.run_it("table1", code=1).stderr)
        setups = {block.setup for block in data.load(self.directory, "schur").blocks}
        self.assertEqual(len(setups), 2)

    def test_solvers_with_one_parameter_in_several_values_are_a_family(self):
        solvers = [f"relax@sweeps={count}" for count in (30, 300)]
        rows = [row for solver in ("relax", "schur", *solvers) for row in whole_system(solver)]
        algorithms = [algorithm("solver", solver, {"sweeps": said_parameters(solver).get("sweeps", "5")}, {"sweeps": "5"})
                      for solver in ("relax", *solvers)]
        write_steps(self.directory / "a", rows)
        write_manifest(self.directory / "a", **newer_manifest("rock_pile", algorithms))
        parts, = solver_groups.groups(data.load(self.directory, "schur").blocks).values()
        table = trade_off.points(parts)
        family = trade_off.families(table)["relax"]
        self.assertEqual(list(family["count"]), [5, 30, 300])
        self.assertEqual(trade_off.full_names(table), {
            "relax": "relax, 5 sweeps", "relax, 30 sweeps": "relax, 30 sweeps", "relax, 300 sweeps": "relax, 300 sweeps",
            "schur": "schur"})


class CheckMatrixTest(Scratch):

    def write(self, change=lambda rows: rows):
        for scene in SCENES:
            rows = matrix(scene, combinations=(*COMBINATIONS, *((name, REFINER) for name in NEWCOMERS)))
            for row in rows:
                if row["partitioner"] in NEWCOMERS:
                    row.update(max_bodies="-", max_part_bodies=70, max_part_bodies_before=70)
            rows += [row | {"partitioner": "-", "refiner": "-", "solver": BASELINE, "status": "not_converged"}
                     for row in matrix(scene, combinations=COMBINATIONS[:1])]
            write_steps(self.directory / scene, change(rows) if scene == "rock_pile" else rows)

    def test_more_than_the_papers_combinations_hold(self):
        self.write()
        self.assertNotIn("FAIL", self.run_it("check_matrix").stdout)

    def test_one_that_is_not_on_every_step_does_not(self):
        self.write(lambda rows: [row for row in rows if (row["partitioner"], row["step"]) != (NEWCOMERS[0], 50)])
        self.assertIn("rock_pile step 50: 18 rows, 18 of 19 combinations", self.run_it("check_matrix", code=3).stdout)

    def test_their_rows_are_checked_too(self):
        for column, value in (("status", "diverged"), ("residual_m_per_s", 1), ("t_s_ms", "nan"), ("interface_rows", 61)):
            def spoil(rows, column=column, value=value):
                next(row for row in rows if row["partitioner"] == NEWCOMERS[1]).update({column: value})
                return rows

            self.write(spoil)
            self.assertIn(f"({SCENES[2]} step 0, {NEWCOMERS[1]} {REFINER})", self.run_it("check_matrix", code=3).stdout)


class NamesTest(unittest.TestCase):

    def test_a_name_says_its_algorithm_and_parameters(self):
        self.assertEqual([base_name(name) for name in ("mr", "mr@tau-mr=2", "file@1f2e")], ["mr", "mr", "file"])
        self.assertEqual(said_parameters("mix@max-bodies=50@tau-mix=0.25"), {"max-bodies": "50", "tau-mix": "0.25"})
        self.assertEqual((said_parameters("mix"), said_parameters("file@1f2e")), ({}, {}))

    def test_first_names_come_first_and_the_others_as_they_are_met(self):
        self.assertEqual(in_order(["z", "b", "a", "z"], ("a", "c")), ["a", "z", "b"])


class AboutTest(unittest.TestCase):

    def test_a_manifest_that_says_nothing_is_read_by_the_table_of_its_version(self):
        older = manifest("rock_pile", sweeps=100)
        self.assertEqual(solver_parameters(older, "pgs")[0]["sweeps"], "100")
        self.assertNotIn("sweeps", solver_parameters(older, "schur")[0])
        self.assertEqual(strategy_and_kernel(older, "schur"), ("pivot", "schur-rows"))
        self.assertEqual(strategy_and_kernel({}, "newton:schur-bodies"), ("newton", "schur-bodies"))
        self.assertLessEqual({"cfm", "max_bodies", "max_iterations"}, set(setup_columns(older)))

    def test_a_manifest_that_says_it_is_believed(self):
        newer = newer_manifest("rock_pile", [algorithm("solver", "x", {"strategy": "newton", "kernel": "k"})])
        self.assertEqual(setup_columns(newer), ("cfm", "max_bodies", "width"))
        self.assertEqual(setup_columns(newer, about=("partition",)), ("max_bodies", "width"))
        self.assertEqual(strategy_and_kernel(newer, "x"), ("newton", "k"))
        self.assertEqual(solver_parameters(newer, "pgs@sweeps=7"), ({"sweeps": "7"}, {}))


if __name__ == "__main__":
    unittest.main()
