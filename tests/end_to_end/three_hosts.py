#!/usr/bin/python3
"""three_hosts.py PROGRAMS [CASE...]

Runs a campaign on three hosts by ssh (peclet run --hosts), as root. The hosts are network namespaces behind a bridge,
each with an sshd and a file system that has nothing of the owner's folder. Cases: calm; cuts of a link of 1 s, 10 s
and beyond the time after which a host counts as lost; slow (10 Mbit/s, 200 ms); kills of all kinds of processes. The
canonical export must be that of one local worker, with trajectories and final configurations, and no seed is blamed.
Needs Debian's packages openssh-server, openssh-client and iproute2.
"""
import contextlib
import os
import random
import signal
import subprocess
import sys
import tempfile
import threading
import time

from launched_campaign import PARTS, Campaign, check, is_part, words_of

PARTS["launcher"] = ("ssh", "-T")
HOSTS = 3
SEEDS = 20
KILLS = 200
BRIDGE = "pecletbr"
CASES = ("calm", "cut 1", "cut 10", "cut 40", "slow", "kills")
LEASE = 40  # s; half of it is the silence after which a host counts as lost
SSHD = """
Port 22
HostKey {folder}/host_key
AuthorizedKeysFile {folder}/key.pub
PidFile {folder}/sshd.{number}
StrictModes no
UsePAM no
MaxSessions 64
MaxStartups 64
"""
SSH = """
Host *
  User root
  IdentityFile {folder}/key
  IdentitiesOnly yes
  StrictHostKeyChecking no
  UserKnownHostsFile /dev/null
  LogLevel ERROR
  BatchMode yes
  ServerAliveInterval 5
  ServerAliveCountMax 3
"""


def run(*words):
    subprocess.run(words, check=True, stdin=subprocess.DEVNULL)


class Hosts:
    """Three namespaces with an sshd each; the owner's side has the address 10.77.0.254."""

    def __init__(self, folder, hidden):
        self.folder, self.hidden, self.servers = folder, hidden, []

    def __enter__(self):
        for name in ("key", "host_key"):
            run("ssh-keygen", "-q", "-t", "ed25519", "-N", "", "-f", os.path.join(self.folder, name))
        with open(os.path.join(self.folder, "ssh_config"), "w") as file:
            file.write(SSH.format(folder=self.folder))
        with open(os.path.join(self.folder, "hosts"), "w") as file:
            file.writelines(f"10.77.0.{number + 1} slots=2\n" for number in range(HOSTS))
        os.makedirs("/run/sshd", exist_ok=True)
        run("ip", "link", "add", BRIDGE, "type", "bridge")
        run("ip", "address", "add", "10.77.0.254/24", "dev", BRIDGE)
        run("ip", "link", "set", BRIDGE, "up")
        for number in range(HOSTS):
            self.begin(number)
        return self

    def begin(self, number):
        host, inner, outer = f"peclet{number}", f"pecletin{number}", f"pecletout{number}"
        run("ip", "netns", "add", host)
        run("ip", "link", "add", outer, "type", "veth", "peer", "name", inner, "netns", host)
        run("ip", "link", "set", outer, "master", BRIDGE, "up")
        run("ip", "-n", host, "address", "add", f"10.77.0.{number + 1}/24", "dev", inner)
        run("ip", "-n", host, "link", "set", inner, "up")
        configuration = os.path.join(self.folder, f"sshd_config.{number}")
        with open(configuration, "w") as file:
            file.write(SSHD.format(folder=self.folder, number=number))
        hidden = f"mount -t tmpfs none '{self.hidden}' && exec /usr/sbin/sshd -D -f '{configuration}'"
        command = ["ip", "netns", "exec", host, "unshare", "-m", "sh", "-c", hidden]
        self.servers.append(subprocess.Popen(command, stdin=subprocess.DEVNULL))

    def __exit__(self, *_):
        for server in self.servers:
            server.kill()
            server.wait()
        for number in range(HOSTS):
            subprocess.run(["ip", "netns", "del", f"peclet{number}"], check=False)
        run("ip", "link", "del", BRIDGE)

    def cut(self, number, seconds):
        run("ip", "link", "set", f"pecletout{number}", "down")
        time.sleep(seconds)
        run("ip", "link", "set", f"pecletout{number}", "up")

    def words(self, through=""):
        launcher = f"{through} ssh -T -F '{self.folder}/ssh_config' {{host}}"
        return f"--launch={launcher.strip()}", f"--hosts={self.folder}/hosts", f"--lease={LEASE}"


def slowly(command):
    """Runs a command behind a link of 10 Mbit/s and 200 ms in each direction."""
    process = subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE)

    def carry(source, target):
        waiting = []  # pieces and their times
        is_open, come = True, threading.Condition()

        def read():
            nonlocal is_open
            while data := os.read(source, 65536):
                with come:
                    come.wait_for(lambda: len(waiting) < 8)
                    waiting.append((time.monotonic() + 0.2, data))
                    come.notify_all()
            with come:
                is_open = False
                come.notify_all()

        threading.Thread(target=read, daemon=True).start()
        while True:
            with come:
                come.wait_for(lambda: waiting or not is_open)
                if not waiting:
                    return os.close(target)
                due, data = waiting.pop(0)
                come.notify_all()
            time.sleep(max(0, due - time.monotonic()))
            view = memoryview(data)
            while view:
                view = view[os.write(target, view) :]
            time.sleep(len(data) * 8 / 10e6)

    threading.Thread(target=carry, args=(0, process.stdin.fileno()), daemon=True).start()
    carry(process.stdout.fileno(), 1)
    return process.wait()


def cut_links(campaign, hosts, seconds, generator):
    """Runs the campaign; meanwhile each of three times a link is cut. Returns the process and what was done."""
    process, done = campaign.run(*hosts.words()), 0
    while process.poll() is None and done < 3:
        time.sleep(generator.uniform(0.2, 0.8))
        hosts.cut(generator.randrange(HOSTS), seconds)
        done += 1
    return process, f"{done} cuts of {seconds} s"


def processes_of(campaign, part):
    if part == "far end":  # ssh passes no environment on
        return [parent_of(process) for process in processes_of(campaign, "engine")]
    return [process for process in campaign.processes() if is_part(words_of(process), part)]


def parent_of(process):
    with contextlib.suppress(OSError):
        with open(f"/proc/{process}/stat") as f:
            return int(f.read().rsplit(")", 1)[1].split()[1])
    return 0


def kill_parts(campaign, hosts, kills, generator):
    """Runs the campaign, killing its parts. Returns the last owner's process and how often each part was killed."""
    process, done = campaign.run(*hosts.words()), dict.fromkeys([*PARTS, "owner"], 0)
    while process.poll() is None and sum(done.values()) < kills:
        time.sleep(generator.uniform(0.05, 0.4))
        part = generator.choice(list(done))
        found = [process.pid] if part == "owner" else processes_of(campaign, part)
        found = [one for one in found if one > 1]
        if not found:
            continue
        with contextlib.suppress(ProcessLookupError):
            os.kill(generator.choice(found), signal.SIGKILL)
            done[part] += 1
        if part == "owner":
            process.wait()
            process = campaign.run(*hosts.words())
    return process, done


def main():
    chosen = sys.argv[2:] or CASES
    with tempfile.TemporaryDirectory(dir="/var/tmp") as keys, tempfile.TemporaryDirectory() as folder:
        calm = Campaign(sys.argv[1], os.path.join(folder, "local"), SEEDS)
        calm.completed(calm.run("--workers=1"), "the local run")
        with Hosts(keys, folder) as hosts:
            time.sleep(1)
            for case in chosen:
                begun = time.monotonic()
                campaign = Campaign(sys.argv[1], os.path.join(folder, case), SEEDS)
                generator, done = random.Random(7), ""
                if case.startswith("cut"):
                    process, done = cut_links(campaign, hosts, float(case.split()[1]), generator)
                elif case == "kills":
                    process, done = kill_parts(campaign, hosts, KILLS, generator)
                else:
                    slowly = f"/usr/bin/python3 {os.path.abspath(__file__)} --slowly" if case == "slow" else ""
                    process = campaign.run(*hosts.words(slowly))
                campaign.completed(process, case)
                check(campaign.export() == calm.export(), case, "gives other results")
                blamed = campaign.ask("SELECT total(blamed) FROM attempt")
                check(blamed == 0, case, "blamed", campaign.query("SELECT * FROM attempt WHERE blamed"))
                attempts = campaign.ask("SELECT count(*) FROM attempt")
                seconds = time.monotonic() - begun
                print(f"{case}: {seconds:.0f} s, {attempts} attempts, {done}: the same bytes", flush=True)


if __name__ == "__main__":
    sys.exit(slowly(sys.argv[2:]) if sys.argv[1:2] == ["--slowly"] else main())
