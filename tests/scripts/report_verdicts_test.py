"""Verdicts, fits and intervals against data whose answers are known."""
import pathlib
import tempfile
import types
import unittest

import numpy
import pandas
from report_data import PAPER, rows_of, write_run

from cleave_scripts.figures import data, interface_cost, ladder_map, spread, style, times_by_size, verdicts
from cleave_scripts.figures.claim import Claim, gain
from cleave_scripts.figures.claim_values import noise
from cleave_scripts.results.paper import SCENES


def judged(directory):
    """{(claim, row): Verdict}"""
    found = verdicts.judge_all(data.load(directory, "schur"), PAPER)
    return {(item.claim.text, item.claim.row): item for item in found}


def pick(found, *words):
    """The one verdict whose claim and row hold all words."""
    hits = [item for key, item in found.items() if all(word in " ".join(key) for word in words)]
    assert len(hits) == 1, (words, [item.claim.row for item in hits])
    return hits[0]


class VerdictTest(unittest.TestCase):

    def setUp(self):
        scratch = tempfile.TemporaryDirectory()
        self.addCleanup(scratch.cleanup)
        self.directory = pathlib.Path(scratch.name)

    def write(self, change=lambda row: None, scenes=SCENES, name="", **options):
        for scene in scenes:
            rows = rows_of(scene, **options)
            for row in rows:
                change(row)
            write_run(self.directory / (name + scene), rows)

    def test_the_papers_own_table_gives_its_own_figures(self):
        self.write()
        found = judged(self.directory)
        for words, percent in ((("mindp + fm, said 31",), 22.2), (("mindp + kl, said 12",), 11.7),
                               (("mix + fm, said 31",), 30.8), (("Rock Pile, said 46",), 46.0),
                               (("Large Rock Pile, said 35",), 36.2), (("lowest solver time", "Chain Drop"),
                                                                       -3.0), (("lowest solver time",
                                                                                "Log Tower"), 23.2),
                               (("consistently", "Log Tower"), -2.2), (("bfs + fm against",), 2.9)):
            hits = [item for key, item in found.items() if all(word in " ".join(key) for word in words)]
            item = min(hits, key=lambda hit: len(hit.claim.row))
            self.assertAlmostEqual(100 * item.paper, percent, 1, words)
            self.assertAlmostEqual(item.ours, item.paper, 9, words)

    def test_the_papers_own_times_reproduce_what_its_table_shows_and_nothing_else(self):
        self.write()
        for item in judged(self.directory).values():
            if item.claim.paper_cells:
                expected = verdicts.NOT_REPRODUCED if item.paper_disagrees else verdicts.REPRODUCED
                self.assertEqual(item.verdict, expected, item.claim)
        self.assertEqual(sum(item.paper_disagrees for item in judged(self.directory).values()), 2)

    def test_the_reverse_is_not_reproduced(self):
        self.write(lambda row: row.update(t_s_ms=1e3 / row["t_s_ms"], t_s_min_ms=1e3 / row["t_s_min_ms"]))
        found = judged(self.directory)
        for words in (("mindp + fm, said 31",), ("mix + fm, said 31",), ("fastest", "Chain Drop")):
            self.assertEqual(pick(found, *words).verdict, verdicts.NOT_REPRODUCED, words)

    def test_counted_columns_decide_where_noise_hides_the_gain(self):
        random = numpy.random.default_rng(3)

        def noisy(row):
            row["t_s_ms"] = row["t_s_min_ms"] = float(numpy.exp(random.normal(0, 1)))

        work = {"none": 10, "kl": 7, "fm": 5}
        said, peaks = ("mindp + fm, said 31",), ("peaks", "mindp + fm")  # the latter states no size
        for words, sign, rows_sign, expected in ((said, 1, 1, verdicts.REPRODUCED), (said, -1, -1,
                                                                                     verdicts.NOT_REPRODUCED),
                                                 (peaks, -1, 1, verdicts.WITHIN_NOISE)):

            def change(row, sign=sign, rows_sign=rows_sign):
                noisy(row)
                size = work[row["refiner"]]**sign
                rows_cut = work[row["refiner"]]**rows_sign
                row.update(factor_mflop_local=0, factor_mflop_interface=size, interface_rows=1000 * rows_cut)

            self.write(change, ("log_tower",))
            item = pick(judged(self.directory), *words)
            self.assertLess(item.low, item.least)
            self.assertGreater(item.high, item.least)
            self.assertEqual(item.verdict, expected)

    def test_a_gain_that_is_too_small_by_mflop_is_not_reproduced_though_interface_rows_fall(self):
        random = numpy.random.default_rng(3)
        work = {"none": 1.0, "kl": 0.98, "fm": 0.95}

        def change(row):
            row["t_s_ms"] = row["t_s_min_ms"] = float(numpy.exp(random.normal(0, 1)))
            row.update(factor_mflop_local=0,
                       factor_mflop_interface=work[row["refiner"]],
                       interface_rows=1000 * work[row["refiner"]])

        self.write(change, ("log_tower",))
        item = pick(judged(self.directory), "mindp + fm, said 31")
        self.assertGreater(item.interface_rows, 0)
        self.assertEqual(item.verdict, verdicts.NOT_REPRODUCED)
        self.assertIn("too small", item.reason)

    def test_counted_columns_that_are_the_same_decide_nothing(self):
        random = numpy.random.default_rng(3)

        def change(row):
            row["t_s_ms"] = row["t_s_min_ms"] = float(numpy.exp(random.normal(0, 1)))
            row.update(factor_mflop_local=1, factor_mflop_interface=2, interface_rows=300)

        self.write(change, ("log_tower",))
        item = pick(judged(self.directory), "peaks", "mindp + fm")
        self.assertEqual((item.mflop, item.interface_rows), (0, 0))
        self.assertEqual(item.verdict, verdicts.WITHIN_NOISE)

    def test_noise_without_counted_columns_stays_noise(self):
        random = numpy.random.default_rng(4)
        rows = rows_of("log_tower")
        for row in rows:
            row["t_s_ms"] = row["t_s_min_ms"] = float(numpy.exp(random.normal(0, 1)))
            del row["factor_mflop_local"]
        write_run(self.directory / "log_tower", rows)
        self.assertEqual(pick(judged(self.directory), "mindp + fm, said 31").verdict, verdicts.WITHIN_NOISE)

    def test_too_few_steps_are_left_to_the_counted_columns(self):
        self.write(scenes=("log_tower",), steps=(9, 19, 29))
        item = pick(judged(self.directory), "mindp + fm, said 31")
        self.assertTrue(numpy.isnan(item.low))
        self.assertEqual(item.reason, "by Mflop and interface rows")

    def test_a_repeated_run_that_says_otherwise_widens_the_interval(self):
        self.write(scenes=("log_tower",))
        alone = pick(judged(self.directory), "mindp + fm, said 31")
        self.write(lambda row: row.update(t_s_ms=10.0, t_s_min_ms=10.0), ("log_tower",), name="again_")
        both = pick(judged(self.directory), "mindp + fm, said 31")
        self.assertEqual((alone.runs, both.runs), (1, 2))
        self.assertLessEqual(both.low, 0)
        self.assertEqual(both.high, alone.high)
        short = [dict(row, step=500) for row in rows_of("log_tower", steps=(9,))]
        write_run(self.directory / "short", [row for row in short if row["refiner"] != "kl"])
        self.assertEqual(pick(judged(self.directory), "mindp + fm, said 31").runs, 2)

    def test_karger_is_open_until_it_exists(self):
        self.write()
        found = judged(self.directory)
        for scene in SCENES:
            item = found["the Karger partitioner is not competitive", scene.replace("_", " ").title()]
            self.assertEqual(item.verdict, verdicts.OPEN)
            self.assertIn("karger", item.reason)
        rows = rows_of("rock_pile") + rows_of("rock_pile", ("karger",), t_s_ms=5000.0, t_s_min_ms=5000.0)
        write_run(self.directory / "rock_pile", rows)
        item = judged(self.directory)["the Karger partitioner is not competitive", "Rock Pile"]
        self.assertEqual(item.verdict, verdicts.REPRODUCED)

    def test_karger_is_judged_in_the_run_that_has_it(self):
        self.write()
        rows = rows_of("log_tower", ("mindp", "mix"), t_s_ms=9.0, t_s_min_ms=9.0)
        rows += rows_of("log_tower", ("karger",), t_s_ms=8.0, t_s_min_ms=8.0)
        write_run(self.directory / "karger" / "log_tower", rows)
        item = judged(self.directory)["the Karger partitioner is not competitive", "Log Tower"]
        self.assertEqual((item.verdict, round(item.ours, 3)), (verdicts.NOT_REPRODUCED, -0.125))

    def test_mass_ratio_and_any_condition_column_that_comes(self):
        self.write()
        found = judged(self.directory)
        self.assertEqual(pick(found, "part_mass_ratio_max").verdict, verdicts.REPRODUCED)
        self.assertEqual(pick(found, "part_condition").verdict, verdicts.OPEN)
        self.write(lambda row: row.update(part_condition_estimate=1e3), ("large_rock_pile",))
        self.assertEqual(
            pick(judged(self.directory), "part_condition_estimate").verdict, verdicts.NOT_REPRODUCED)

    def test_size_independence(self):
        self.write()
        for growth, expected in ((2.0, verdicts.REPRODUCED), (1.0, verdicts.NOT_REPRODUCED)):
            for size in (50, 100, 200):
                rows = rows_of("rock_pile", ("mindp", "mix"))
                for row in rows:
                    t_s = size**2 if row["refiner"] == "none" else 0.7 * size**growth
                    row.update(bodies=size, t_s_ms=t_s, t_s_min_ms=t_s)
                write_run(self.directory / "scaling" / str(size), rows, bodies=size)
            item = pick(judged(self.directory), "mindp", "less that of fm")
            self.assertAlmostEqual(item.ours, 2.0 - growth, 9)
            self.assertEqual(item.verdict, expected)

    def test_without_any_rows_everything_is_open(self):
        write_run(self.directory / "x", rows_of("elsewhere"))
        self.assertEqual({item.verdict for item in judged(self.directory).values()}, {verdicts.OPEN})


class FitTest(unittest.TestCase):

    def test_power_law(self):
        x = numpy.array([50, 100, 400, 800.0])
        fit = times_by_size.fit_power(x, 0.03 * x**1.7)
        self.assertAlmostEqual(fit.exponent, 1.7, 12)
        self.assertAlmostEqual(fit.factor, 0.03, 12)
        self.assertLess(fit.error, 1e-12)
        self.assertTrue(numpy.isnan(times_by_size.fit_power(x[:2], x[:2]).error))
        # One point off by a factor e moves the exponent by the known weight of that point.
        logs = numpy.log(x) - numpy.log(x).mean()
        off = times_by_size.fit_power(x, x**1.7 * numpy.array([1, 1, 1, numpy.e]))
        self.assertAlmostEqual(off.exponent, 1.7 + logs[3] / (logs**2).sum(), 12)

    def test_cubic_trend_finds_both_terms_over_many_scales(self):
        for a, c in ((8.0, 1e-7), (0.01, 1e-4), (3000.0, 1e-6)):
            r = numpy.array([20.0, 60, 110, 300, 500, 900])
            found = interface_cost.cubic_trend(r, a + c * r**3)
            numpy.testing.assert_allclose(found, (a, c, 1), rtol=1e-6)

    def test_cubic_trend_of_what_is_not_cubic(self):
        r = numpy.array([20.0, 60, 110, 300, 500, 900])
        a, c, share = interface_cost.cubic_trend(r, 1e4 / r)
        self.assertTrue(a > 0 and c >= 0 and share < 0.1, (a, c, share))

    def test_intervals_cover_the_mean_about_as_often_as_they_say(self):
        random = numpy.random.default_rng(5)
        covered = 0
        for _ in range(200):
            values = random.normal(3, 1, (60, 1))
            low, high = spread.interval(spread.resampled_means(values)[:, 0])
            covered += low <= 3 <= high
        self.assertTrue(0.85 <= covered / 200 <= 0.99, covered)

    def test_resamples_are_blocks_and_repeatable(self):
        indices = spread.resample_indices(64)
        self.assertEqual(indices.shape, (spread.RESAMPLES, 64))
        self.assertEqual(spread.block_length(64), 4)
        steps = numpy.diff(indices.reshape(-1, 16, 4)) % 64
        self.assertTrue((steps == 1).all())
        numpy.testing.assert_array_equal(indices, spread.resample_indices(64))

    def test_steps_of_two_places_are_not_drawn_together(self):
        cells = tuple((place, "mindp", "none") for place in ("rocks 50", "rocks 100"))
        claim = Claim("", "", "", cells, gain(*cells))
        values = numpy.random.default_rng(5).normal(10, 1, (50, 1))
        same = {place: pandas.DataFrame(values, columns=[("mindp", "none")]) for place, *_ in cells}
        low, high = noise(claim, same)
        self.assertTrue(-0.1 < low < -0.01 < 0.01 < high < 0.1, (low, high))


class LadderTest(unittest.TestCase):

    def ladder(self, lines):
        names = ["rung", "parameter", "value", "solver", "status"]
        ladder = pandas.DataFrame([dict(zip(names, line.split())) for line in lines])
        return ladder.assign(series=ladder[ladder_map.series_of(ladder)])

    def test_first_failing_rung_in_the_order_of_the_file(self):
        ladder = self.ladder([
            "stiff cfm 1e-4 a ok", "stiff cfm 1e-8 a not_converged", "stiff cfm 0 a ok",
            "stiff cfm 1e-4 b ok", "stiff cfm 1e-8 b ok", "stiff cfm 0 b ok"
        ])
        self.assertEqual(ladder_map.climb(ladder, "stiff", "a"), (1 / 3, "1e-8"))
        self.assertEqual(ladder_map.climb(ladder, "stiff", "b"), (1.0, None))
        self.assertIsNone(ladder_map.climb(ladder, "stiff", "c"))

    def test_a_rung_holds_only_when_all_its_rows_do(self):
        ladder = self.ladder(["stiff cfm 1 a ok", "stiff cfm 1 a crashed", "stiff cfm 0 a ok"])
        self.assertEqual(ladder_map.climb(ladder, "stiff", "a"), (0.0, "1"))

    def test_physics_is_judged_apart_where_there_is_such_a_column(self):
        ladder = self.ladder(["stiff cfm 1 a ok", "stiff cfm 0 a ok"])
        ladder["physics"] = ["ok", "too_low"]
        self.assertEqual(ladder_map.climb(ladder, "stiff", "a", "status"), (1.0, None))
        self.assertEqual(ladder_map.climb(ladder, "stiff", "a", "physics"), (0.5, "0"))
        for columns in (ladder.columns, ladder.columns.drop("physics")):
            figure = ladder_map.draw(
                types.SimpleNamespace(tree=types.SimpleNamespace(ladder=ladder[columns])))[0]
            titles = [ax.get_title(loc="left") for ax in figure.axes if ax.get_title(loc="left")]
            self.assertEqual(len(titles), 1 + ("physics" in columns))
            style.pyplot.close(figure)

    def test_values_are_short(self):
        for value, text in (("0.016666666666666666", "0.0167"), ("100000", "1e5"), ("1e-06", "1e-6"),
                            ("0", "0"), ("500", "500"), ("high", "high")):
            self.assertEqual(ladder_map._short(value), text)

    def test_rungs_with_a_name_of_their_own_are_grouped_by_parameter(self):
        ladder = self.ladder(["cfm_a cfm 1 a ok", "cfm_b cfm 0 a diverged"])
        self.assertEqual(ladder_map.climb(ladder, "cfm", "a"), (0.5, "0"))


if __name__ == "__main__":
    unittest.main()
