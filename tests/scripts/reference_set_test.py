"""What is stored under results/ was made by one clean commit of the history, and says so."""
import json
import subprocess
import unittest

from synthetic import ROOT

from cleave_scripts.measurements import fuzzing

RESULTS = ROOT / "results"
READ_FROM_RUNS = ("report/verdicts.csv", "figures/figure3.png", "campaign_costs.csv")


def manifests():
    return sorted(RESULTS.rglob("manifest.json"))


def provenance():
    return json.loads((RESULTS / "provenance.json").read_text())["files"]


class ReferenceSetTest(unittest.TestCase):

    def entries(self):
        """(name, what says how it was made)"""
        return [(str(path.relative_to(RESULTS)), json.loads(path.read_text())) for path in manifests()
               ] + list(provenance().items())

    def test_all_of_it_names_clean_commits_that_are_in_the_history(self):
        self.assertGreater(len(manifests()), 0)
        for name, entry in self.entries():
            self.assertEqual(entry["build"]["git_dirty"], "false", name)
        for commit in {entry["build"]["git_hash"] for _, entry in self.entries()}:
            done = subprocess.run(["git", "-C", ROOT, "merge-base", "--is-ancestor", commit, "HEAD"],
                                  capture_output=True, text=True, check=False)
            self.assertEqual(done.returncode, 0, f"{commit} is not in the history: {done.stderr}")

    def check_one_commit_and_machine(self, entries):
        commits, machines = {}, set()
        for name, entry in entries:
            commits.setdefault(entry["build"]["git_hash"], []).append(name)
            machines.add((entry["machine"]["cpu_model"], entry["machine"]["cores"]))
        self.assertEqual(len(commits), 1, {commit: names[:3] for commit, names in commits.items()})
        self.assertEqual(len(machines), 1, machines)

    def test_all_runs_and_what_is_read_from_them_are_of_one_commit_and_machine(self):
        read = [(name, provenance()[name]) for name in READ_FROM_RUNS]
        self.check_one_commit_and_machine([entry for entry in self.entries() if entry[0].endswith("manifest.json")] + read)

    def test_what_one_command_made_is_of_one_commit_and_machine(self):
        """So is all that scripts/reference made, where a command of its own has not made it anew since: that names its own
        commit, and so does its table."""
        made = {}
        for name, entry in provenance().items():
            for maker in (entry["command"], *(["scripts/reference"] if "out/reference/" in entry["command"] else [])):
                made.setdefault(maker, []).append((name, entry))
        self.assertGreater(max(map(len, made.values())), 1)
        for entries in made.values():
            self.check_one_commit_and_machine(entries)

    def test_every_file_has_a_manifest_or_stands_in_provenance(self):
        described = set(provenance())
        for path in RESULTS.rglob("*"):
            name = str(path.relative_to(RESULTS))
            if name.startswith("torture/"):
                continue
            if path.is_file() and path.suffix != ".md" and name != "provenance.json" and path.name != "manifest.json":
                beside = path.name in ("steps.csv", "checksums") and (path.parent / "manifest.json").exists()
                self.assertTrue(beside or name in described, f"results/{name}: neither a manifest nor provenance")
        for name in described:
            self.assertTrue((RESULTS / name).exists(), f"results/provenance.json names {name}, which is not there")

    def test_the_hostile_trials_say_themselves_what_made_them_and_found_nothing_wrong(self):
        for folder in ("torture", "torture/campaigns"):
            with self.subTest(folder):
                self.check_hostile_trials(folder)
        self.assertEqual({path.name for path in (RESULTS / "torture").iterdir()}, {"torture.json", "torture.md", "campaigns"})

    def test_a_campaign_was_killed_a_hundred_times_and_a_thousand_flips_were_found(self):
        kinds = json.loads((RESULTS / "torture" / "campaigns" / "torture.json").read_text())["kinds"]
        self.assertGreaterEqual(kinds["campaign-flips"]["noticed"], 1000)
        self.assertEqual(kinds["campaign-flips"]["noticed"], kinds["campaign-flips"]["trials"])
        self.assertGreaterEqual(kinds["campaign-kills"]["kills"], 100)
        self.assertEqual(kinds["campaign-kills"]["restarts"], kinds["campaign-kills"]["trials"])

    def check_hostile_trials(self, folder):
        told = json.loads((RESULTS / folder / "torture.json").read_text())
        self.assertIn(f"--out results/{folder}", told["command"])
        self.assertIn("clean", told["program"])
        self.assertTrue(told["machine"])
        self.assertEqual((told["state"], told["not_run"]), ("complete", {}))
        self.assertEqual((told["total"]["above"], told["total"]["not_judged"]), (0, 0))
        page = (RESULTS / folder / "torture.md").read_text().partition("| kind | finding | times |")[2]
        listed = [line.strip("| ").split(" | ") for line in page.splitlines()[2:]]
        self.assertEqual(sum(int(times) for *_, times in listed), told["total"]["findings"])
        for _, finding, _ in listed:  # what became of it
            self.assertIn(f'"{finding}": of the trial.', (RESULTS / "README.md").read_text())

    def test_the_fuzzers_ran_for_an_hour_in_all_and_found_nothing(self):
        text = (RESULTS / "fuzz" / "README.md").read_text()
        rows = {cells[0]: cells for cells in (line.strip("| ").split(" | ") for line in text.splitlines())
                if cells[0] in fuzzing.TARGETS}
        self.assertEqual(set(rows), set(fuzzing.TARGETS))
        for name, (_, _, commit, minutes, *_, findings) in rows.items():
            self.assertGreaterEqual(int(minutes), 12, name)
            self.assertEqual((len(commit), findings), (10, "0"), name)

    def test_every_run_is_complete_and_knows_no_path_of_the_machine(self):
        for path in manifests():
            manifest = json.loads(path.read_text())
            self.assertEqual(manifest["state"], "complete", path)
            self.assertFalse([word for word in manifest["argv"] if word.startswith("/")], path)


if __name__ == "__main__":
    unittest.main()
