"""Which columns of steps.csv `verify` recomputes from the files beside it, as results/README.md lists them."""
import functools

from cleave_scripts.results.programs import ROOT

README = ROOT / "results" / "README.md"


@functools.cache
def recomputable_columns(command):
    return frozenset()
