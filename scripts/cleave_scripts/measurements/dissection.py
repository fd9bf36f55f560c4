"""Arithmetic of a factorisation in the order of METIS's nested dissection, of the pattern of a recorded problem: counted from
the file alone, by the library and by numpy, and by nothing of the program."""
import ctypes

import h5py
import numpy

from cleave_scripts.results.errors import ResultError

BLOCK = 6  # rows and columns of a body
METIS_OK = 1
LIBRARY = "libmetis.so.5"


class Graph:
    """Bodies that share a row are neighbours: those of body i are adjacency[first[i]:first[i + 1]]."""

    def __init__(self, body_count, pairs):
        """pairs: (k, 2) of bodies, in any order and as often as they come."""
        both = numpy.unique(numpy.concatenate([pairs, pairs[:, ::-1]]), axis=0)
        self.adjacency = numpy.ascontiguousarray(both[:, 1], dtype=numpy.int32)
        self.first = numpy.searchsorted(both[:, 0], numpy.arange(body_count + 1)).astype(numpy.int32)
        self.body_count = body_count

    def neighbours(self, body):
        return self.adjacency[self.first[body]:self.first[body + 1]]


def graph_of(path):
    """Of a problem file."""
    with h5py.File(path) as file:
        bodies = file["row_body"][()].reshape(-1, 2)
        return Graph(len(file["mass"]), bodies[(bodies >= 0).all(axis=1)])


def order_by_metis(graph):
    """The body at every position, by METIS_NodeND with its defaults."""
    try:
        library = ctypes.CDLL(LIBRARY)
    except OSError:
        raise ResultError(f"{LIBRARY} cannot be loaded; run scripts/setup first") from None
    body_at_position, position_of_body = numpy.empty((2, graph.body_count), dtype=numpy.int32)
    arrays = (array.ctypes.data_as(ctypes.POINTER(ctypes.c_int32)) for array in (graph.first, graph.adjacency))
    written = (array.ctypes.data_as(ctypes.POINTER(ctypes.c_int32)) for array in (body_at_position, position_of_body))
    status = library.METIS_NodeND(ctypes.byref(ctypes.c_int32(graph.body_count)), *arrays, None, None, *written)
    if status != METIS_OK:
        raise ResultError(f"METIS_NodeND: status {status}")
    return body_at_position


def factor_mflop(graph, body_at_position):
    """Sum of squared column counts of the Cholesky factor, without padding, as factor_mflop_local counts."""
    position = numpy.empty(graph.body_count, dtype=numpy.int64)
    position[body_at_position] = numpy.arange(graph.body_count)
    below_children = [[] for _ in range(graph.body_count)]  # by parent: the rows of its children
    flops = 0
    for place, body in enumerate(body_at_position):
        later = position[graph.neighbours(body)]
        rows = numpy.unique(numpy.concatenate([later[later > place], *below_children[place]]))
        below_children[place] = None
        if rows.size:
            below_children[rows[0]].append(rows[1:])
        flops += sum((BLOCK * rows.size + k)**2 for k in range(1, BLOCK + 1))
    return 1e-6 * flops


def dissection_mflop(path):
    graph = graph_of(path)
    return factor_mflop(graph, order_by_metis(graph))
