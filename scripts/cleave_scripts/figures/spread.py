"""Noise of a mean over steps: a block bootstrap, because successive steps are alike."""
import numpy

RESAMPLES = 2000
CONFIDENCE = 0.95
SEED = 1


def block_length(steps):
    return max(1, round(steps**(1 / 3)))


def resample_indices(steps, place=""):
    """(RESAMPLES, steps) indices: whole blocks of successive steps drawn with replacement, ends joined. What was measured in
    different places has nothing in common: each draws its own."""
    block = block_length(steps)
    starts = numpy.random.default_rng([SEED, *place.encode()]).integers(steps, size=(RESAMPLES, -(-steps // block)))
    return ((starts[:, :, None] + numpy.arange(block)) % steps).reshape(RESAMPLES, -1)[:, :steps]


def resampled_means(table):
    """(RESAMPLES, columns): means of the columns of a (steps, columns) array over each resample."""
    # One column at a time keeps the memory at RESAMPLES x steps.
    indices = resample_indices(len(table))
    return numpy.column_stack([column[indices].mean(axis=1) for column in table.T])


def interval(values, confidence=CONFIDENCE):
    """The middle share of the values as (low, high); nan where there are none."""
    values = values[~numpy.isnan(values)]
    if not len(values):
        return numpy.nan, numpy.nan
    return tuple(numpy.quantile(values, [(1 - confidence) / 2, (1 + confidence) / 2]))
