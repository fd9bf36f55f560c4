"""The price of an exact answer by other people's solvers."""
from cleave_scripts.documents.stored import need
from cleave_scripts.measurements.peer_times import OURS, SLOW_MS, markdown
from cleave_scripts.table import text

TIMES = ("peer_times.csv", "scripts/peers")


def peer_times(stored):
    rows = need(stored.table(*TIMES), "the times of other people's solvers", "peer_timeout_s")
    steps, rounds = (list(dict.fromkeys(row[column] for row in rows)) for column in ("step", "round"))
    table, sentences = markdown(rows)
    return (f"The same recorded steps {text.listed(steps)} of settled rock piles, cfm 1e-5, by `{OURS}` and by the solvers "
            f"of others, one thread, in turn (`{TIMES[1]}`; {stored.origin(TIMES[0])}). Of a step the median of {len(rounds)} "
            f"rounds, but what took more than {SLOW_MS / 1000:g} s was solved once; then medians over the steps, and the "
            "largest residual of them. The last column is between the smallest pile and the largest; MuJoCo's rows are its "
            f"own:\n\n{table}\n\n{sentences}")


BLOCKS = {"peer_times": peer_times}
