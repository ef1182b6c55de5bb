"""A private Slurm on one machine: munged, slurmctld and a slurmd for each node from Debian's packages, run by the
test's user with files in a temporary folder. Each node claims CPUS processors, whatever the machine has. Jobs of the
partition `urgent` preempt those of `usual`, which are queued again.
"""
import contextlib
import os
import pwd
import signal
import socket
import subprocess
import time

from campaign_folder import comes_true, processes_with

CPUS = 4

CONFIGURATION = """
ClusterName=drill
SlurmctldHost={host}(127.0.0.1)
SlurmUser={user}
SlurmdUser={user}
SlurmctldPort={controller_port}
AuthType=auth/munge
AuthInfo=socket={folder}/munge.socket,cred_expire=5
CredType=cred/munge
StateSaveLocation={folder}/state
SlurmdSpoolDir={folder}/node-%n
SlurmctldPidFile={folder}/slurmctld.pid
SlurmdPidFile={folder}/slurmd-%n.pid
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SwitchType=switch/none
MpiDefault=none
JobAcctGatherType=jobacct_gather/none
AccountingStorageType=accounting_storage/none
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU_Memory
DefMemPerCPU=200
SchedulerType=sched/backfill
SchedulerParameters=sched_interval=1,batch_sched_delay=0,sched_min_interval=0,bf_interval=1
PreemptType=preempt/partition_prio
PreemptMode=REQUEUE
SlurmdParameters=config_overrides
ReturnToService=2
SlurmdTimeout=5
KillWait=5
MessageTimeout=5
# Jobs that have ended are forgotten soon, as on a busy cluster.
MinJobAge=2
MaxArraySize=101
{nodes}
PartitionName=usual Nodes=ALL Default=YES MaxTime=INFINITE PriorityTier=1 PreemptMode=REQUEUE State=UP
PartitionName=urgent Nodes=ALL Default=NO MaxTime=INFINITE PriorityTier=10 PreemptMode=OFF State=UP
"""
NODE = "NodeName={name} NodeHostname={host} NodeAddr=127.0.0.1 Port={port} CPUs={cpus} RealMemory=1000 State=UNKNOWN"


def free_port():
    with socket.socket() as listener:
        listener.bind(("127.0.0.1", 0))
        return listener.getsockname()[1]


class Cluster:
    def __init__(self, folder, nodes=1):
        self.folder = folder
        self.nodes = [f"drill{number}" for number in range(1, nodes + 1)]
        self.processes = {}
        for part in ("state", "log"):
            os.makedirs(os.path.join(folder, part))
        with open(os.open(os.path.join(folder, "munge.key"), os.O_WRONLY | os.O_CREAT, 0o600), "wb") as key:
            key.write(os.urandom(128))
        self.configuration = os.path.join(folder, "slurm.conf")
        host = socket.gethostname().split(".")[0]
        with open(self.configuration, "w") as f:
            f.write(
                CONFIGURATION.format(
                    folder=folder,
                    host=host,
                    user=pwd.getpwuid(os.getuid()).pw_name,
                    controller_port=free_port(),
                    nodes="\n".join(NODE.format(name=n, host=host, port=free_port(), cpus=CPUS) for n in self.nodes),
                )
            )
        os.environ["SLURM_CONF"] = self.configuration

    def __enter__(self):
        try:
            self.start(
                "munged",
                "--foreground",
                "--force",
                f"--key-file={self.folder}/munge.key",
                f"--socket={self.folder}/munge.socket",
                f"--pid-file={self.folder}/munge.pid",
                f"--log-file={self.folder}/log/munge.log",
                f"--seed-file={self.folder}/munge.seed",
            )
            self.start_controller()
            for node in self.nodes:
                self.start_node(node)
            self.wait_until(lambda: self.say("sinfo", "-h", "-o", "%T %D") == f"idle {len(self.nodes)}", "idle nodes")
        except BaseException:
            self.__exit__()
            raise
        return self

    def __exit__(self, *_):
        if "slurmctld" in self.processes:
            self.clear()
        for name in (*self.nodes, "slurmctld", "munged"):
            if name in self.processes:
                self.stop(name)

    def start(self, name, *arguments, process=None, environment=None):
        program = os.path.join("/usr/sbin", name)
        if not os.path.exists(program):
            raise SystemExit(f"{program} is missing; Debian's packages slurm-wlm and munge have it")
        process = process or name
        log = open(os.path.join(self.folder, "log", process + ".out"), "a")
        command = [program, *arguments]
        self.processes[process] = subprocess.Popen(
            command, stdout=log, stderr=log, stdin=subprocess.DEVNULL, env={**os.environ, **(environment or {})}
        )

    def stop(self, name, number=signal.SIGTERM):
        process = self.processes.pop(name)
        process.send_signal(number)
        try:
            process.wait(15)
        except subprocess.TimeoutExpired:
            process.kill()
            process.wait()

    def start_controller(self):
        self.start("slurmctld", "-D", "-f", self.configuration)

    def start_node(self, name):
        arguments = ("-D", "-N", name, "-f", self.configuration)
        self.start("slurmd", *arguments, process=name, environment={"DRILL_NODE": name})

    def kill_node(self, name):
        """Kills slurmd, the keepers of its steps and the processes of the steps."""
        for process in processes_with("DRILL_NODE", name) + processes_with("SLURMD_NODENAME", name):
            with contextlib.suppress(ProcessLookupError):
                os.kill(process, signal.SIGKILL)
        self.processes.pop(name).wait()

    def restart_controller(self):
        """Starts the controller, and waits until it answers."""
        self.start_controller()
        self.wait_until(lambda: self.say("scontrol", "ping").endswith("UP"), "the controller")

    def clear(self):
        """Ends all jobs and waits up to 20 s until their processes have ended."""
        end = time.monotonic() + 20
        while self.say("squeue", "-h", "--me") and time.monotonic() < end:
            self.say("scancel", "--me")
            self.resume_nodes()
            time.sleep(0.5)

    def say(self, *command):
        """Returns the output of a command, or "" if it fails."""
        answer = subprocess.run(command, capture_output=True, text=True)
        return answer.stdout.strip() if answer.returncode == 0 else ""

    def wait_until(self, is_so, what, seconds=60):
        if not comes_true(is_so, seconds, 0.1):
            raise AssertionError(f"waited {seconds} s for {what}\n{self.say('squeue')}\n{self.log()}")

    def log(self):
        text = ""
        for name in sorted(os.listdir(os.path.join(self.folder, "log"))):
            with open(os.path.join(self.folder, "log", name), errors="replace") as f:
                text += f"--- {name}\n" + "".join(f.readlines()[-15:])
        return text

    def tasks(self, state="RUNNING"):
        """Returns array elements in a state, as JOB_INDEX, without those of the urgent job."""
        lines = self.say("squeue", "-h", "-r", "--me", "--states=" + state, "-o", "%j %F_%K").split("\n")
        return [line.split()[1] for line in lines if line and not line.startswith("urgent ")]

    def resume_nodes(self):
        """Resumes nodes that Slurm has drained; returns their number."""
        drained = self.say("sinfo", "-h", "-N", "--states=drain,down", "-o", "%n").split()
        for node in set(drained):
            self.say("scontrol", "update", "nodename=" + node, "state=resume")
        return len(set(drained))

    def restarts(self):
        """Returns how often the elements known to Slurm were queued again."""
        words = self.say("scontrol", "show", "job", "-o").split()
        return sum(int(word.split("=")[1]) for word in words if word.startswith("Restarts="))
