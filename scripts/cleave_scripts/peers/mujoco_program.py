"""The program cleave_mujoco, which steps a recorded pile as a model of MuJoCo."""
import json
import subprocess

from cleave_scripts.peers.mujoco_model import model_of, start_velocity
from cleave_scripts.results.errors import ResultError, last_line
from cleave_scripts.results.whole_file import write_bytes


def stepped(mujoco, pile, model, cone, repeats, later):
    """What cleave_mujoco says of the pile, written to the file `model`: of its first step, `repeats` times,
    and of `later` steps in a row."""
    write_bytes(model, model_of(pile, cone).encode())
    done = subprocess.run([mujoco, model, str(repeats), str(later)], input=start_velocity(pile), capture_output=True,
                          text=True, check=False)
    if done.returncode != 0:
        raise ResultError(last_line(done.stderr, "cleave_mujoco failed"))
    return json.loads(done.stdout)
