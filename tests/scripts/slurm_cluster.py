"""A Slurm of its own for a test: two nodes of one core on this host, daemons, ports, key and files of their own,
gone at the end."""
import contextlib
import ctypes
import getpass
import os
import pathlib
import secrets
import signal
import socket
import subprocess
import sys
import time

NODES = ("node1", "node2")
PATIENCE_S = 300  # far more than anything takes, also on a busy machine
PR_SET_PDEATHSIG, PR_SET_CHILD_SUBREAPER = 1, 36
LIBC = ctypes.CDLL(None, use_errno=True)
# Nodes may claim a core that is not there (config_overrides); no cgroups, no accounting, no name of a host is looked up.
# A task that is requeued waits for its credential to expire, which takes two minutes by default.
CONFIG = """ClusterName=cleave
SlurmctldHost={host}(127.0.0.1)
SlurmctldPort={ports[0]}
SlurmUser={user}
SlurmdUser={user}
AuthType=auth/munge
AuthInfo=socket={root}/munge.socket,cred_expire=20
StateSaveLocation={root}/state
SlurmdSpoolDir={root}/spool.%n
SlurmctldPidFile={root}/slurmctld.pid
SlurmdPidFile={root}/slurmd.%n.pid
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SwitchType=switch/none
MpiDefault=none
JobAcctGatherType=jobacct_gather/none
AccountingStorageType=accounting_storage/none
SchedulerType=sched/builtin
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU
SlurmdParameters=config_overrides
ReturnToService=2
SlurmdTimeout=300
NodeName={nodes} NodeHostname={host} NodeAddr=127.0.0.1 Port={ports[1]},{ports[2]} CPUs=1 State=UNKNOWN
PartitionName=main Nodes=ALL Default=YES MaxTime=INFINITE State=UP
"""


def free_ports(count):
    """That nobody listens on now."""
    with contextlib.ExitStack() as stack:
        sockets = [stack.enter_context(socket.socket()) for _ in range(count)]
        for one in sockets:
            one.bind(("127.0.0.1", 0))
        return [one.getsockname()[1] for one in sockets]


def until(what, holds):
    """What holds() gives, once that is true."""
    end = time.monotonic() + PATIENCE_S
    while not (found := holds()):
        if time.monotonic() > end:
            raise TimeoutError(f"waited {PATIENCE_S} s until {what}")
        time.sleep(0.1)
    return found


def children_of(process):
    """All processes below one, those of its threads too."""
    found = []
    for file in pathlib.Path(f"/proc/{process}/task").glob("*/children"):
        with contextlib.suppress(OSError):
            for child in map(int, file.read_text().split()):
                found += [child, *children_of(child)]
    return found


class Cluster:
    """Used as a context. run(): a command of Slurm; environment: what reaches this Slurm."""

    def __init__(self, root):
        self.root = pathlib.Path(root)
        self.environment = dict(os.environ, SLURM_CONF=str(self.root / "slurm.conf"))
        self.daemons = []

    def __enter__(self):
        LIBC.prctl(PR_SET_CHILD_SUBREAPER, 1)  # what daemons leave behind becomes ours to end
        try:
            self._configure()
            self._start_munge()
            self._start("slurmctld", "-D")
            for node in NODES:
                self._start("slurmd", "-D", "-N", node)
            until("both nodes are idle", lambda: self.states() == {node: "idle" for node in NODES})
        except BaseException:
            self.__exit__(*sys.exc_info())
            raise
        return self

    def __exit__(self, kind, error, trace):
        if kind:
            for log in sorted(self.root.glob("*.log")):
                print(f"--- {log.name}\n{log.read_text(errors='replace')[-3000:]}", file=sys.stderr)
        for daemon in reversed(self.daemons):
            daemon.terminate()
        for daemon in self.daemons:
            with contextlib.suppress(subprocess.TimeoutExpired):
                daemon.wait(10)
        end = time.monotonic() + PATIENCE_S
        while (left := children_of(os.getpid())) and time.monotonic() < end:
            for process in left:
                with contextlib.suppress(ProcessLookupError):
                    os.kill(process, signal.SIGKILL)
            with contextlib.suppress(ChildProcessError):
                while os.waitpid(-1, os.WNOHANG)[0]:
                    pass
            time.sleep(0.02)
        LIBC.prctl(PR_SET_CHILD_SUBREAPER, 0)

    def _configure(self):
        (self.root / "state").mkdir()
        key = self.root / "munge.key"
        key.touch(0o600)
        key.write_bytes(secrets.token_bytes(256))
        (self.root / "slurm.conf").write_text(
            CONFIG.format(root=self.root, host=socket.gethostname().partition(".")[0], user=getpass.getuser(),
                          nodes=",".join(NODES), ports=free_ports(3)))

    def _start_munge(self):
        place = self.root / "munge.socket"
        self._start("munged", "--foreground", "--force", f"--key-file={self.root}/munge.key", f"--socket={place}",
                    f"--pid-file={self.root}/munged.pid", f"--seed-file={self.root}/munged.seed")
        until("munged listens", place.exists)

    def _start(self, *words):
        """A daemon that dies with us."""
        with open(self.root / f"{'_'.join(words[:1] + words[3:4])}.log".replace("/", "_")[:80], "wb") as log:
            self.daemons.append(
                subprocess.Popen(words, env=self.environment, stdin=subprocess.DEVNULL, stdout=log, stderr=log,
                                 preexec_fn=lambda: LIBC.prctl(PR_SET_PDEATHSIG, signal.SIGKILL)))

    def run(self, *words, check=True):
        done = subprocess.run(words, env=self.environment, capture_output=True, text=True, timeout=PATIENCE_S, check=False)
        if check and done.returncode != 0:
            raise RuntimeError(f"{' '.join(words)}: {done.stderr}")
        return done.stdout

    def states(self):
        """{node: its state}"""
        lines = self.run("sinfo", "--noheader", "--Node", "--format=%N %T", check=False).splitlines()
        return dict(line.split() for line in lines)

    def job(self, number):
        """{field: value} of a job or a task of an array."""
        words = self.run("scontrol", "--oneliner", "show", "job", number).split()
        return dict(word.partition("=")[::2] for word in words)

    def end_of(self, number):
        """Its exit code as "0:0", once it has ended."""
        until(f"job {number} has ended",
              lambda: self.job(number)["JobState"] in ("COMPLETED", "FAILED", "CANCELLED", "NODE_FAIL"))
        return self.job(number)["ExitCode"]
