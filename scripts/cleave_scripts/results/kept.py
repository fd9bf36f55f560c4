"""What was made is not made again: a line a step in a file, for what no campaign of cleave sweep runs.

A step has a `label` and `arguments`. Lines of another build or machine do not count.
"""
import json
import os
import pathlib

from cleave_scripts.results.build_key import difference


class Journal:

    def __init__(self, path, key):
        self.path, self.key = pathlib.Path(path), key
        self.finished = {entry["arguments"]: entry for entry in self._entries() if difference(entry["key"], key) is None}

    def _entries(self):
        text = self.path.read_text(encoding="utf-8", errors="replace") if self.path.exists() else ""
        self.is_torn = not text.endswith("\n") and text != ""  # a line that was being written when all was stopped
        for line in text.splitlines():
            try:
                entry = json.loads(line)
            except ValueError:
                continue
            if isinstance(entry, dict) and {"key", "arguments", "result"} <= entry.keys():
                yield entry

    def keep_or_run(self, step, run, tell=lambda text: None):
        """The result of a step: the one that is noted, else that of run(step)."""
        kept = self.result_of(step)
        if kept is not None:
            tell(f"{step.label} is kept")
            return kept
        result = run(step)
        self.note(step, result)
        return result

    def result_of(self, step):
        """The one that was noted last; None where there is none."""
        entry = self.finished.get(" ".join(step.arguments))
        return entry and entry["result"]

    def note(self, step, result):
        entry = {"key": self.key, "arguments": " ".join(step.arguments), "result": result}
        self.path.parent.mkdir(parents=True, exist_ok=True)
        with self.path.open("a", encoding="utf-8") as file:
            file.write("\n" * self.is_torn + json.dumps(entry) + "\n")
            file.flush()
            os.fsync(file.fileno())
        self.is_torn = False
        self.finished[entry["arguments"]] = entry
