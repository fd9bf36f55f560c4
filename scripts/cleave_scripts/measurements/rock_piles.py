"""Rock piles of growing size, of which Figure 4 is drawn."""
from cleave_scripts.campaigns.spec import load_spec
from cleave_scripts.campaigns.sweep import asked


def scaling_spec(options):
    """Campaign `scaling` as a script's options want it: all sizes once, then again, for every repeat."""
    return load_spec("scaling") | asked(options, "steps", "measure-every", "threads", "seed") | {"rounds": options.repeats}
