"""What a row of steps.csv says of its solve; rows are dictionaries of texts."""
import math

from cleave_scripts.results.names import NO_PARTITIONER

FAR_NS = 300  # core_round_trip_ns from which cores are far apart, as the program says


def group(rows, *columns):
    """{values of the columns: rows}"""
    groups = {}
    for row in rows:
        groups.setdefault(tuple(row[column] for column in columns), []).append(row)
    return groups


def has_parts(row):
    return row["partitioner"] != NO_PARTITIONER


def combination(row):
    """'mindp+fm'; NO_PARTITIONER for a solver that works on the whole system."""
    return f"{row['partitioner']}+{row['refiner']}" if has_parts(row) else NO_PARTITIONER


def split_ms(row):
    return float(row["t_pr_ms"]) if has_parts(row) else 0.0


def total_ms(row):
    """t_pr + t_s."""
    return split_ms(row) + float(row["t_s_ms"])


def relative_residual(row):
    """In units of the velocity scale, max(1 m/s, largest free velocity)."""
    return float(row["residual_m_per_s"]) / max(1.0, float(row["largest_free_velocity_m_per_s"]))


def is_far(row):
    """Whether its threads were on cores far apart. Rows without the column were measured before there was one."""
    return float(row.get("core_round_trip_ns", math.nan)) >= FAR_NS
