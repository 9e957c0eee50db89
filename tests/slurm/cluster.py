"""A private Slurm for one test: munged, slurmctld and several slurmd on loopback, without systemd or cgroups."""
import os
import pathlib
import shutil
import signal
import socket
import subprocess
import time

HOST = socket.gethostname().split(".")[0]

CONFIGURATION = """\
ClusterName=talus
SlurmctldHost={host}(127.0.0.1)
SlurmctldPort={port}
SlurmUser={user}
SlurmdUser={user}
AuthType=auth/munge
CredType=cred/munge
AuthInfo=socket={dir}/munge/socket,cred_expire=5
CommunicationParameters=NoInAddrAny,NoCtldInAddrAny
StateSaveLocation={dir}/state
SlurmctldPidFile={dir}/slurmctld.pid
SlurmctldLogFile={dir}/slurmctld.log
SlurmdPidFile={dir}/slurmd-%n.pid
SlurmdLogFile={dir}/slurmd-%n.log
SlurmdSpoolDir={dir}/spool-%n
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
JobAcctGatherType=jobacct_gather/none
AccountingStorageType=accounting_storage/none
MpiDefault=none
SchedulerType=sched/builtin
SchedulerParameters=batch_sched_delay=0,sched_interval=1
SelectType=select/cons_tres
SelectTypeParameters=CR_Core
PreemptType=preempt/partition_prio
PreemptMode=REQUEUE
ReturnToService=2
SlurmctldTimeout=30
SlurmdTimeout=5
KillWait=5
MinJobAge={min_job_age}
MessageTimeout=5
SlurmdParameters=config_overrides
MailProg=/bin/true
"""


def free_ports(count):
    """The first of `count` successive ports that are free now."""
    for first in range(20000 + os.getpid() % 10000, 60000, count):
        try:
            for port in range(first, first + count):
                with socket.socket() as s:
                    s.bind(("127.0.0.1", port))
            return first
        except OSError:
            continue
    raise AssertionError("no free ports")


class Cluster:
    def __init__(self, directory, nodes=2, cpus=1, min_job_age=300):
        self.dir = pathlib.Path(directory)
        self.nodes, self.port = [f"n{i + 1}" for i in range(nodes)], free_ports(nodes + 1)
        self.environment = {**os.environ, "SLURM_CONF": str(self.dir / "slurm.conf")}
        for name in ("munge", "state", *(f"spool-{n}" for n in self.nodes)):
            (self.dir / name).mkdir(parents=True)
        user = subprocess.check_output(["id", "-un"], text=True).strip()
        text = CONFIGURATION.format(host=HOST, port=self.port, dir=self.dir, user=user, min_job_age=min_job_age)
        for i, name in enumerate(self.nodes):
            text += (f"NodeName={name} NodeHostname={HOST} NodeAddr=127.0.0.1 Port={self.port + 1 + i} CPUs={cpus} "
                     f"RealMemory=2000 State=UNKNOWN\n")
        every = f"Nodes={','.join(self.nodes)} MaxTime=INFINITE State=UP"
        text += f"PartitionName=batch Default=YES PriorityTier=1 {every}\n"
        text += f"PartitionName=urgent PriorityTier=10 {every}\n"
        (self.dir / "slurm.conf").write_text(text)
        (self.dir / "cgroup.conf").write_text("CgroupPlugin=cgroup/v1\n")  # or slurmd looks for a mounted one

    def start(self):
        key = self.dir / "munge/key"
        key.touch(mode=0o600)
        key.write_bytes(os.urandom(1024))
        (self.dir / "munge").chmod(0o755)
        munge = self.dir / "munge"
        self.run("/usr/sbin/munged", "--force", f"--key-file={key}", f"--socket={munge}/socket", f"--pid-file={munge}/pid",
                 f"--log-file={munge}/log", f"--seed-file={munge}/seed", "--num-threads=2")
        self.start_controller()
        for name in self.nodes:
            self.start_node(name)
        self.wait("nodes to be idle", lambda: len(self.run("sinfo", "-hN", "-tidle", "-o%N", "-pbatch").split()) == len(self.nodes))
        return self

    def run(self, *arguments, check=True):
        done = subprocess.run(arguments, env=self.environment, capture_output=True, text=True, timeout=60)
        if check and done.returncode != 0:
            raise AssertionError(f"{' '.join(map(str, arguments))} ended with {done.returncode}: {done.stderr}\n{self.logs()}")
        return done.stdout

    def wait(self, what, condition, seconds=60):
        deadline = time.monotonic() + seconds
        while not condition():
            if time.monotonic() > deadline:
                raise AssertionError(f"waited {seconds} s for {what}\n{self.run('squeue', check=False)}\n{self.logs()}")
            time.sleep(0.1)

    def logs(self):
        files = [self.dir / "munge/log", *sorted(self.dir.glob("slurm*.log"))]
        return "\n".join(f"--- {f.name}\n{f.read_text(errors='replace')[-1500:]}" for f in files if f.exists())

    def start_controller(self):
        self.run("/usr/sbin/slurmctld", "-f", self.dir / "slurm.conf")

    def stop_controller(self):
        self.end(self.pid("slurmctld.pid"), signal.SIGTERM)

    def start_node(self, name):
        self.run("/usr/sbin/slurmd", "-f", self.dir / "slurm.conf", "-N", name)

    def kill_node(self, name):
        """As if its power were gone: the daemon, the watchers of its jobs and the jobs, before any can tell."""
        jobs = self.processes(f"SLURMD_NODENAME={name}")
        watchers = {self.parent(pid) for pid in jobs} - set(jobs) - {0, 1}
        for pid in [self.pid(f"slurmd-{name}.pid"), *watchers, *jobs]:
            self.end(pid, signal.SIGKILL)

    def stop(self):
        for job in self.processes("SLURMD_NODENAME="):
            watcher = self.parent(job)
            if watcher > 1 and watcher != os.getpid() and pathlib.Path(f"/proc/{watcher}/comm").read_text().strip() == "slurmstepd":
                self.end(watcher, signal.SIGKILL)
            self.end(job, signal.SIGKILL)
        for file in ["slurmctld.pid", *(f"slurmd-{n}.pid" for n in self.nodes), "munge/pid"]:
            self.end(self.pid(file), signal.SIGKILL)
        shutil.rmtree(self.dir, ignore_errors=True)

    def pid(self, file):
        try:
            return int((self.dir / file).read_text())
        except (OSError, ValueError):
            return 0

    def processes(self, variable):
        """Of our cluster alone: our configuration stands in their environment."""
        found = []
        for entry in pathlib.Path("/proc").iterdir():
            try:
                if entry.name.isdigit() and int(entry.name) != os.getpid():
                    environment = (entry / "environ").read_bytes().split(b"\0")
                    if f"SLURM_CONF={self.dir}/slurm.conf".encode() in environment and \
                            any(v.startswith(variable.encode()) for v in environment):
                        found.append(int(entry.name))
            except OSError:
                pass
        return found

    @staticmethod
    def parent(pid):
        try:
            return int(pathlib.Path(f"/proc/{pid}/stat").read_text().rsplit(")", 1)[1].split()[1])
        except OSError:
            return 0

    @staticmethod
    def end(pid, number):
        """Sends the signal and waits until it is gone."""
        if pid <= 1:
            return
        try:
            os.kill(pid, number)
            for _ in range(300):
                os.kill(pid, 0)
                if pathlib.Path(f"/proc/{pid}/stat").read_text().rsplit(")", 1)[1].split()[0] == "Z":
                    return
                time.sleep(0.02)
        except (ProcessLookupError, FileNotFoundError):
            pass
