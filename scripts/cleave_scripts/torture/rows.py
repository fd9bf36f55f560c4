"""The rows of a replay against the judge: what they say of a solution has to be so."""
import csv
import math


def judge_rows(trial, out, problems):
    """Every row of out/steps.csv whose solution was written; problems: {name: path as it was given to the program}."""
    rows = read_rows(trial, out / "steps.csv")
    for name, problem in problems.items():
        of_file = [row for row in rows if row["problem_file"].rpartition("/")[2] == name]
        written = out / name
        verdicts = trial.judge(problem, written) if written.is_file() else None
        if verdicts is None:
            trial.count("not_judged", len(of_file))
            continue
        for row in of_file:
            _judge_row(trial, row, verdicts.get("+".join((row["partitioner"], row["refiner"], row["solver"]))))


def read_rows(trial, path):
    try:
        with open(path, newline="", encoding="utf-8") as file:
            return list(csv.DictReader(file))
    except (OSError, ValueError, csv.Error) as error:
        trial.find("steps.csv cannot be read", str(error))
        return []


def _judge_row(trial, row, verdict):
    where = f"step {row['step']}, {row['partitioner']}+{row['refiner']}+{row['solver']}"
    if verdict is None:
        trial.count("not_judged")
        if row["status"] == "ok":
            trial.find("a row says ok and has no solution", where)
        return
    trial.count("judged")
    told = _number(row["residual_m_per_s"])
    if row["status"] == "ok" and verdict.above():
        trial.count("above")
        trial.find("a row says ok above the limit", f"{where}: {verdict}, the row says {told}")
    elif math.isfinite(verdict.residual) and verdict.differs_from(told):
        trial.find("a row tells another residual", f"{where}: {verdict}, the row says {told}")
    elif not _overflowed(row, verdict) and verdict.velocity_error > max(1e-9, 1e6 * verdict.rounding):
        trial.find("a velocity is not that of its impulses", f"{where}: {verdict}")


def _overflowed(row, verdict):
    """Whether the velocity is beyond 64 bits, and the row says so."""
    return row["status"] == "diverged" and math.isinf(verdict.velocity_error)


def _number(text):
    try:
        return float(text)
    except ValueError:
        return math.nan
