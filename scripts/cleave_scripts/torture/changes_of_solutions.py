"""Stored solutions and partitions, and whole files, that are changed. Tables as in changes_of_values.py.

UNTRUE: what is stored is not what the problem gives. `verify` has to say so; `replay` does not look at it.
"""
import os

import h5py
import numpy as np

from cleave_scripts.torture.changes_of_values import ANY, REFUSED, rewrite

UNTRUE = "untrue"


def _solution(file, dice):
    """Some solution; one is made up where there is none."""
    if not file.get("solution"):
        made = file.create_group("solution/-+-+made")
        made.attrs.update(solver="made", strategy="-", kernel="-", partitioner="-", refiner="-", residual_m_per_s=0.0)
        made["impulse"], made["velocity"] = np.zeros(len(file["rhs"])), np.zeros((len(file["mass"]), 6))
    return file["solution"][dice.choice(list(file["solution"]))]


def _impulse(file, dice):
    data = _solution(file, dice)["impulse"]
    data[dice.randrange(len(data))] += dice.choice([1e-3, -1.0, 1e6, float("nan"), float("inf")])


def _velocity(file, dice):
    data = _solution(file, dice)["velocity"]
    data[dice.randrange(len(data)), dice.randrange(6)] += dice.choice([1e-3, -1.0, 1e6, float("nan")])


def _flattered(file, dice):
    group = _solution(file, dice)
    group["impulse"][...] = group["impulse"][...] + 1e-2
    group.attrs["residual_m_per_s"] = 1e-15


def _cut_solution(file, dice):
    group = _solution(file, dice)
    name = dice.choice(["impulse", "velocity"])
    if dice.random() < 0.5:
        del group[name]
    else:
        rewrite(group, name, group[name][:][:-1])


def _wrong_label(file, dice):
    group = _solution(file, dice)
    labels = ("x", "a\nb", "mix+fm", "mix+fm+schur+schur", "++", "\x1b[31m", "x" * 3000)
    file.move(group.name, "solution/" + dice.choice(labels))


def _no_attribute(file, dice):
    group = _solution(file, dice)
    del group.attrs[dice.choice(list(group.attrs))]


def _part_ids(file, dice):
    group = file.get("partition")
    if not group:
        made = file.create_group("partition/mindp+none+schur")
        made["part_of_body"] = np.full(len(file["mass"]), -7, "i4")
        made.attrs.update(partitioner="mindp", refiner="none")
        return
    data = group[dice.choice(list(group))]["part_of_body"]
    data[dice.randrange(len(data))] = dice.choice([-1, -2**31, 2**31 - 1, len(data), 10**6])


def _many_solutions(file, dice):
    source = _solution(file, dice)
    for number in range(dice.choice([10, 100])):
        file.copy(source, f"solution/many+{number}+schur")


CHANGES = (
    ("an impulse changed", UNTRUE, _impulse),
    ("a velocity changed", UNTRUE, _velocity),
    ("a residual that flatters", UNTRUE, _flattered),
    ("half a solution", UNTRUE, _cut_solution),
    ("a solution under another name", UNTRUE, _wrong_label),
    ("a solution without one of its attributes", ANY, _no_attribute),
    ("part ids that are none", UNTRUE, _part_ids),
    ("many solutions", UNTRUE, _many_solutions),
)


def _shorter(path, dice):
    os.truncate(path, dice.randrange(os.path.getsize(path)))


def _empty(path, _dice):
    os.truncate(path, 0)


def _plain_text(path, _dice):
    path.write_text("mass,1\n")


def _noise(path, dice):
    path.write_bytes(dice.randbytes(dice.randrange(1, 5000)))


def _noise_after_signature(path, dice):
    path.write_bytes(b"\x89HDF\r\n\x1a\n" + dice.randbytes(dice.randrange(1, 5000)))


def _overwritten(path, dice):
    """A run of bytes, anywhere."""
    size = os.path.getsize(path)
    with open(path, "r+b") as file:
        file.seek(dice.randrange(size))
        file.write(dice.randbytes(dice.randrange(1, 200)))


def _fifo(path, _dice):
    path.unlink()
    os.mkfifo(path)


def _directory(path, _dice):
    path.unlink()
    path.mkdir()


def _circular_link(path, _dice):
    path.unlink()
    path.symlink_to(path.name)


def _device(path, dice):
    path.unlink()
    path.symlink_to(dice.choice(["/dev/zero", "/dev/null", "/dev/tty", "/proc/self/mem"]))


def _behind_a_user_block(path, _dice):
    with h5py.File(path) as read, h5py.File(path.with_suffix(".new"), "w", userblock_size=512) as written:
        written.attrs.update(read.attrs)
        for name in read:
            read.copy(name, written)
    path.with_suffix(".new").rename(path)


# Whole files: a change takes the path.
FILE_CHANGES = (
    ("a file cut short", REFUSED, _shorter),
    ("an empty file", REFUSED, _empty),
    ("a text", REFUSED, _plain_text),
    ("noise", REFUSED, _noise),
    ("noise behind the signature", REFUSED, _noise_after_signature),
    ("bytes overwritten", ANY, _overwritten),
    ("a pipe", REFUSED, _fifo),
    ("a directory", REFUSED, _directory),
    ("a link to itself", REFUSED, _circular_link),
    ("a device", REFUSED, _device),
    ("a user block", ANY, _behind_a_user_block),
)
