"""What tells whether measurements of before still stand: the commit, how it was built, and the machine.

The program itself says them (cleave run ... --print-key).
"""
import json
import subprocess

from cleave_scripts.results.errors import ResultError, last_line

BUILD = ("git_hash", "git_dirty", "compiler", "flags", "build_type")
MACHINE = ("cpu_model", "cores")


def version_of(program):
    """The line with which a program says what it is."""
    done = subprocess.run([program, "--version"], capture_output=True, text=True, errors="replace", check=False)
    if done.returncode != 0:
        raise ResultError(f"{program} --version stopped with exit code {done.returncode}")
    return done.stdout.partition("\n")[0]


def build_key(program):
    """{name: value} of BUILD and MACHINE."""
    command = [str(program), "run", "--scene", "chain_drop", "--out", "-", "--print-key"]
    try:
        done = subprocess.run(command, capture_output=True, text=True, errors="replace", check=False)
        key = json.loads(done.stdout) if done.returncode == 0 else {}
    except (OSError, ValueError) as error:
        raise ResultError(f"{program} --print-key does not work: {error}") from None
    if done.returncode != 0:
        raise ResultError(f"{program} --print-key stopped with exit code {done.returncode}: {last_line(done.stderr)}")
    missing = [name for name in (*BUILD, *MACHINE) if not isinstance(key, dict) or name not in key]
    if missing:
        raise ResultError(f"{program} --print-key does not say {', '.join(missing)}; build it anew")
    return {name: key[name] for name in (*BUILD, *MACHINE)}


def difference(kept, wanted):
    """Why what was made under `kept` is not of the build and machine of `wanted`, in words; None where it is."""
    if wanted["git_dirty"] != "false":
        return "this build has local changes or no commit, and results of such a build are never kept"
    if kept.get("git_dirty") != "false":
        return "they were made by a build with local changes or without a commit"
    if kept["git_hash"] != wanted["git_hash"]:
        return f"they were made by commit {str(kept['git_hash'])[:10]}, this is {wanted['git_hash'][:10]}"
    for names, other in ((BUILD, "by a program built otherwise"), (MACHINE, "on another machine")):
        for name in names:
            if kept.get(name) != wanted[name]:
                return f"they were made {other}: {name} {kept.get(name)}, here {wanted[name]}"
    return None
