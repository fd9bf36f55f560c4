"""How the scenes with a crane are run: heavy loads on light links want small steps and stiff joints."""

SCENE_OPTIONS = ("--dt", "0.001", "--cfm", "1e-10")  # as `cleave list scenes` gives them
