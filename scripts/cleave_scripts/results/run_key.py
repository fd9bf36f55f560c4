"""The one key that decides whether results are there already: run id + threads + commit + how it was built + machine.

The program itself says what a run would be known by (cleave run ... --print-key), so that `all` stands for the
partitioners, refiners and solvers of today; a manifest says what its results are known by.
"""
import json
import subprocess

from cleave_scripts.results.errors import ResultError

RUN = ("run_id", "threads")
BUILD = ("git_hash", "git_dirty", "flags", "build_type")
MACHINE = ("cpu_model", "cores")


def program_key(program, arguments):
    """arguments: run ..., as the program would get them; what it does not take is refused in its own words."""
    command = [str(program), *map(str, arguments), "--print-key"]
    try:
        done = subprocess.run(command, capture_output=True, text=True, errors="replace", check=False)
        key = json.loads(done.stdout) if done.returncode == 0 else {}
    except (OSError, ValueError) as error:
        raise ResultError(f"{program} --print-key does not work: {error}") from None
    if done.returncode != 0:
        words = (done.stderr.strip().splitlines() or ["no message"])[-1]
        own = words.partition("cleave run: ")[2]
        raise ResultError(own or f"{program} --print-key stopped with exit code {done.returncode}: {words}")
    missing = [name for name in (*RUN, *BUILD, *MACHINE) if not isinstance(key, dict) or name not in key]
    if missing:
        raise ResultError(f"{program} --print-key does not say {', '.join(missing)}; build it anew")
    return key


def build_key(program):
    """The part of the key that is the same for every run: the build and the machine."""
    key = program_key(program, ("run", "--scene", "chain_drop", "--out", "-"))
    return {name: key[name] for name in (*BUILD, *MACHINE)}


def manifest_key(manifest):
    parts = (manifest, manifest.get("options", {}), manifest.get("build", {}), manifest.get("machine", {}))
    return {name: part.get(name) for names, part in zip((RUN[:1], RUN[1:], BUILD, MACHINE), parts) for name in names}


def place_difference(kept, wanted):
    """Why results known as `kept` are not of the build and machine of `wanted`, in words; None where they are."""
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


def difference(kept, wanted):
    """Why results known as `kept` are not those of `wanted`, in words; None where they are."""
    reason = place_difference(kept, wanted)
    for name in RUN:
        if reason is None and name in wanted and kept.get(name) != wanted[name]:
            reason = f"they are of another experiment: {name} {kept.get(name)}, wanted {wanted[name]}"
    return reason
