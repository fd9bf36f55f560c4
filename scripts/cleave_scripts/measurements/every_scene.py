"""Every scene but the ladders, and how it is run; how those are moved that take too long otherwise."""
from cleave_scripts.results.paper import SCENES

MECHANISM_OPTIONS = ("--dt", "0.001", "--cfm", "1e-10")  # as `cleave list scenes` gives them: heavy loads on light links
EVERY_SCENE = dict.fromkeys((*SCENES, "silo"), ()) | dict.fromkeys(("crane", "mixed_site"), MECHANISM_OPTIONS)
MOVED_FAST = ("--advance", "pgs@sweeps=30")  # which is not exact
