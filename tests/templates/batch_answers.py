#!/usr/bin/python3
"""batch_answers.py [TEST...]

Tests templates/pbs and templates/lsf without PBS and LSF: fake_commands.py answers as their commands do, and notes how
they are called. Answers have the form of OpenPBS 23 and of IBM Spectrum LSF 10.1. Nothing of peclet is built.
"""
import json
import os
import re
import shlex
import shutil
import signal
import stat
import subprocess
import sys
import tempfile
import time
import unittest

HERE = os.path.dirname(os.path.abspath(__file__))
TEMPLATES = os.path.join(HERE, "..", "..", "templates")
NAME = "flow-1a2b3c-0001"
LONGER = NAME + "0"  # another job's, of which NAME is the beginning
PLAIN = re.compile(r"[A-Za-z0-9_@+=:,./-]+")  # a value that any line may have

# A task: notes its words and the signal, and leaves with 75 a moment later. SIGUSR2 is left as it is.
PECLET = """#!/usr/bin/python3
import json, os, signal, sys, time
note = {"words": sys.argv[1:], "usr2": signal.getsignal(signal.SIGUSR2) == signal.SIG_IGN, "signals": []}
def write():
    with open(os.environ["NOTE"] + ".new", "w") as file:
        json.dump(note, file)
    os.rename(os.environ["NOTE"] + ".new", os.environ["NOTE"])
for number in (signal.SIGTERM, signal.SIGINT, signal.SIGUSR1):
    signal.signal(number, lambda number, frame: note["signals"].append(number))
print("a task begins", flush=True)
write()
if os.environ.get("LEAVE"):
    sys.exit(int(os.environ["LEAVE"]))
while not note["signals"]:
    time.sleep(0.05)
time.sleep(0.3)
write()
sys.exit(75)
"""


def fill(text, values):
    """Replaces placeholders as peclet does: a line that begins with # takes only plain values."""

    def value(found, line):
        word = values[found[1]]
        assert PLAIN.fullmatch(word) or not line.startswith("#"), f"{found[0]} in {line}"
        return shlex.quote(word)

    return "".join(
        re.sub(r"@([A-Z]+)@", lambda found, line=line: value(found, line), line) for line in text.splitlines(True)
    )


class Bundle(unittest.TestCase):
    """The folder of a bundle, with scripts of a template and commands that answer as they are told."""

    def start(self, system, commands):
        self.system = system
        self.top = tempfile.mkdtemp(prefix=f"batch {system} ")
        self.addCleanup(shutil.rmtree, self.top)
        self.folder = os.path.join(self.top, "odd %J %I ^array_index^ 'ü' $HOME & co: x")
        os.makedirs(os.path.join(self.folder, "logs"))
        for script in os.listdir(os.path.join(TEMPLATES, system)):
            shutil.copy(os.path.join(TEMPLATES, system, script), self.folder)
        programs = os.path.join(self.top, "bin")
        os.mkdir(programs)
        for command in (*commands, "sleep"):
            self.program(
                os.path.join(programs, command), f'exec {sys.executable} {HERE}/fake_commands.py {command} "$@"'
            )
        self.environment = {
            "PATH": f"{programs}:/usr/bin:/bin",
            "HOME": self.top,
            "LC_ALL": "C",
            "FAKE_BATCH": self.top,
        }
        self.answers = {"sleep": [{}]}
        self.make(4)

    def make(self, tasks):
        """Fills in job.sh for so many tasks."""
        with open(os.path.join(TEMPLATES, self.system, "job.sh"), encoding="utf-8") as file:
            text = file.read()
        self.peclet = os.path.join(self.top, "pec let")
        values = {"NAME": NAME, "LAST": str(tasks - 1), "TASKS": str(tasks), "THREADS": "3", "PECLET": self.peclet}
        values |= {"FOLDER": self.folder, "MANIFEST": os.path.join(self.folder, "manifest.json")}
        with open(self.path("job.sh"), "w", encoding="utf-8") as file:
            file.write(fill(text, values))

    def path(self, name):
        return os.path.join(self.folder, name)

    def program(self, path, text):
        with open(path, "w", encoding="utf-8") as file:
            file.write(text if text.startswith("#!") else f"#!/bin/sh\n{text}\n")
        os.chmod(path, stat.S_IRWXU)

    def run_script(self, *words, **environment):
        """Runs sh with these words, and returns what it printed and how it left."""
        calls = os.path.join(self.top, "calls.json")
        if os.path.exists(calls):
            os.remove(calls)
        with open(os.path.join(self.top, "answers.json"), "w", encoding="utf-8") as file:
            json.dump(self.answers, file)
        return subprocess.run(
            ["sh", *words],
            env=self.environment | environment,
            cwd=self.top,
            stdin=subprocess.DEVNULL,
            capture_output=True,
            text=True,
            timeout=60,
        )

    def submit(self, *options, **environment):
        return self.run_script(self.path("submit.sh"), NAME, self.path("job.sh"), *options, **environment)

    def query(self, **environment):
        return self.run_script(self.path("query.sh"), NAME, **environment)

    def cancel(self, **environment):
        return self.run_script(self.path("cancel.sh"), NAME, **environment)

    def largest(self):
        """Runs the text of largest.sh as peclet does, outside a bundle."""
        with open(self.path("largest.sh"), encoding="utf-8") as file:
            return self.run_script("-c", file.read())

    def calls(self, command):
        path = os.path.join(self.top, "calls.json")
        if not os.path.exists(path):
            return []
        with open(path, encoding="utf-8") as file:
            return [call for call in map(json.loads, file) if call["command"] == command]

    def expect(self, done, code, printed=""):
        self.assertEqual((done.returncode, done.stdout), (code, printed), done.stderr)

    def expect_tasks(self, *lines):
        """Expects a complete answer of query.sh."""
        done = self.query()
        self.expect(done, 0, done.stdout)
        self.assertEqual(sorted(done.stdout.splitlines()), sorted(lines))

    def start_job(self, **environment):
        """Starts job.sh as a batch system does, in a session of its own; returns once its task runs."""
        self.program(self.peclet, PECLET)
        self.note = os.path.join(self.top, "note.json")
        environment = self.environment | {"NOTE": self.note, **environment}
        job = subprocess.Popen(
            [self.path("job.sh")], env=environment, cwd=self.top, stdin=subprocess.DEVNULL, start_new_session=True
        )
        self.addCleanup(self.end, job)
        deadline = time.monotonic() + 20
        while not os.path.exists(self.note) and job.poll() is None and time.monotonic() < deadline:
            time.sleep(0.02)
        time.sleep(0.2)  # until it has set its traps
        return job

    @staticmethod
    def end(job):
        if job.poll() is None:
            os.killpg(job.pid, signal.SIGKILL)
            job.wait()

    def noted(self):
        with open(self.note, encoding="utf-8") as file:
            return json.load(file)

    def expect_stop(self, index, send, number, **environment):
        """Expects that a signal makes the task of this index stop with 75."""
        os.chmod(self.path("job.sh"), stat.S_IRWXU)
        job = self.start_job(**environment)
        send(job.pid, number)
        time.sleep(0.1)
        send(job.pid, number)  # some are sent twice
        how = (send.__name__, number)
        self.assertEqual(job.wait(20), 75, how)
        note = self.noted()
        self.assertEqual(note["words"], ["task", self.path("manifest.json"), str(index)], how)
        self.assertTrue(note["signals"], how)
        with open(self.path(f"logs/task-{index}.log"), encoding="utf-8") as file:
            self.assertIn("a task begins\n", file.read())
        os.remove(self.note)
        return note

    def expect_exit_codes(self, **environment):
        os.chmod(self.path("job.sh"), stat.S_IRWXU)
        for code in (1, 3, 75):
            job = self.start_job(LEAVE=str(code), **environment)
            self.assertEqual(job.wait(20), code)
            os.remove(self.note)


class Pbs(Bundle):
    COMMANDS = ("qsub", "qselect", "qdel", "qstat")
    GONE = "Unknown Job Id"

    def setUp(self):
        self.start("pbs", self.COMMANDS)
        self.answers |= {"qsub": [{"out": "12[].tide\n"}], "qselect": [{}], "qdel": [{}], "qstat": [{}]}

    def jobs(self, *moments):
        """Lets each call of qselect see the next of these lists of jobs."""
        self.answers["qselect"] = [{"jobs": jobs} for jobs in moments]

    @staticmethod
    def array(tasks, state="B", number="12", name=NAME):
        return {"id": number, "name": name, "state": state, "tasks": tasks}

    @staticmethod
    def single(state, number="12", name=NAME):
        return {"id": number, "name": name, "state": state}


class PbsSubmits(Pbs):
    def words(self):
        """Returns the words of qsub, without the script that must be the last."""
        (call,) = self.calls("qsub")
        self.assertEqual(call["words"][-1], self.path("job.sh"))
        return call["words"][:-1]

    def test_an_array_with_options_last(self):
        self.expect(self.submit("-l", "walltime=1:00:00", "-q", "short"), 0, "12[].tide\n")
        expected = ["-f", "-N", NAME, "-J", "0-3", "-l", "walltime=1:00:00", "-q", "short"]
        self.assertEqual(self.words(), expected)

    def test_one_task_as_no_array(self):
        self.make(1)
        self.answers["qsub"] = [{"out": "13.tide\n"}]
        self.expect(self.submit(), 0, "13.tide\n")
        self.assertEqual(self.words(), ["-f", "-N", NAME])

    def test_directives_have_the_threads_and_no_paths(self):
        with open(self.path("job.sh"), encoding="utf-8") as file:
            directives = [line.rstrip() for line in file if line.startswith("#PBS")]
        self.assertEqual(directives, ["#PBS -l select=1:ncpus=3", "#PBS -j oe", "#PBS -V"])

    def test_where_what_pbs_prints_is_looked_for(self):
        self.submit()
        self.assertEqual(self.calls("qsub")[0]["folder"], self.path("logs"))

    def test_without_variables_that_would_mislead(self):
        self.submit(PBS_DPREFIX="#QSUB", PBS_ARRAY_INDEX="5", PECLET_INSTRUCTION_SET="avx2")
        environment = self.calls("qsub")[0]["environment"]
        self.assertNotIn("PBS_DPREFIX", environment)
        self.assertNotIn("PBS_ARRAY_INDEX", environment)
        self.assertEqual(environment["PECLET_INSTRUCTION_SET"], "avx2")

    def test_the_number_among_other_words(self):
        self.answers["qsub"] = [{"out": "Project: reef\n12[].tide\n", "err": "qsub: 3 h are left\n"}]
        self.expect(self.submit(), 0, "12[].tide\n")

    def test_options_that_are_refused(self):
        refused = [["-N", "mine"], ["-Nmine"], ["-J", "0-9"], ["-J0-9:2"], ["-I"], ["-X"], ["-z"], ["-G"]]
        refused += [["-W", "block=true"], ["-Wblock=true"], ["-W", "umask=022,block=true"], ["-Wumask=022, block=true"]]
        refused += [["-W", "interactive=true"], ["--version"], ["--", "/bin/true"], ["-hz"], ["-VI"], ["-fNmine"]]
        refused += [["other.sh"], ["-l"], ["-q", "short", "-J"]]
        for options in refused:
            self.expect(self.submit(*options), 2)
            self.assertEqual(self.calls("qsub"), [], options)

    def test_values_that_look_like_options(self):
        options = [
            "-v",
            "-N",
            "-A",
            "-J",
            "-W",
            "group_list=blockers",
            "-h",
            "-M",
            "me@reef",
            "-Wdepend=afterok:7.tide",
        ]
        self.expect(self.submit(*options), 0, "12[].tide\n")
        self.assertEqual(self.words()[5:], options)

    def test_how_it_fails(self):
        # Errors have the exit codes of OpenPBS: its error number, modulo 256.
        cases = [
            ("qsub: Unknown queue\n", 15018 % 256, 1),
            ("qsub: Unauthorized Request \n", 15007 % 256, 1),
            ("Connection refused\nqsub: cannot connect to server tide (errno=111)\n", 111, 1),
            ("Communication failure.\nqsub: cannot connect to server tide (errno=15031)\n", 183, 1),
            ("sh: qsub: not found\n", 127, 1),
            ("qsub: illegal -l value\nusage: qsub ...\n", 2, 1),
            ("qsub: Premature end of message\n", 183, 75),
            ("qsub: End of File\n", 183, 75),
            ("qsub: Non-digit found where a digit was expected\n", 183, 75),
            ("qsub: Error (15031) submitting job\n", 183, 75),
            ("qsub: Batch protocol error\n", 1, 75),
            ("", 137, 75),  # killed
            ("", 0, 75),  # a success without a number
            ("qsub: cannot change start time of a non-empty reservation\n", 15179 % 256, 1),  # 75 by chance
        ]
        for words, code, expected in cases:
            self.answers["qsub"] = [{"err": words, "code": code}]
            done = self.submit()
            self.expect(done, expected)
            self.assertIn(words, done.stderr)

    def test_how_to_stay_within_a_limit(self):
        limits = ["Array job exceeds server or queue size limit", "Maximum number of jobs already in queue"]
        limits += ["would exceed queue short's per-user limit of jobs in 'Q' state"]
        for words in limits:
            self.answers["qsub"] = [{"err": f"qsub: {words}\n", "code": 3}]
            done = self.submit()
            self.expect(done, 1)
            self.assertIn("--largest-array N", done.stderr)

    def test_nothing_that_has_no_tasks(self):
        with open(self.path("job.sh"), "w", encoding="utf-8") as file:
            file.write("#!/bin/bash\n")
        self.expect(self.submit(), 2)
        self.assertEqual(self.calls("qsub"), [])


class PbsKeepsTheServer(Pbs):
    def servers(self, command):
        names = ("PBS_SERVER", "PBS_DEFAULT")
        return {tuple(call["environment"].get(name) for name in names) for call in self.calls(command)}

    def expect_server(self, server):
        self.jobs([self.array(["R", "Q"])])
        later = {"PBS_SERVER": "nereus", "PBS_DEFAULT": "nereus"}  # of another shell
        self.expect(self.query(**later), 0, "12[].tide 0 running\n12[].tide 1 waiting\n")
        self.assertEqual(self.servers("qselect"), {(server, server)})
        self.expect(self.cancel(**later), 0)
        self.assertEqual(self.servers("qdel"), {(server, server)})

    def test_of_an_option(self):
        self.submit("-q", "short@triton")
        self.expect_server("triton")
        self.submit("-q@triton", "-l", "walltime=9", PBS_SERVER="proteus")
        self.expect_server("triton")

    def test_of_a_variable(self):
        self.submit("-q", "short", PBS_DEFAULT="proteus")
        self.expect_server("proteus")
        self.submit(PBS_SERVER="triton", PBS_DEFAULT="proteus")
        self.expect_server("triton")

    def test_of_the_machine(self):
        self.submit()
        self.expect_server(None)


class PbsQueries(Pbs):
    def test_every_state_of_a_task(self):
        self.jobs([self.array(["Q", "H", "W", "T", "R", "E", "S", "U", "X"])])
        waiting = [f"12[].tide {index} waiting" for index in range(4)]
        self.expect_tasks(*waiting, *[f"12[].tide {index} running" for index in range(4, 8)])

    def test_a_held_array_and_one_that_has_not_begun(self):
        for state in "HQWT":
            self.jobs([self.array(["Q", "Q"], state)])
            self.expect_tasks("12[].tide 0 waiting", "12[].tide 1 waiting")

    def test_a_job_that_is_no_array(self):
        for state in "QHWT":
            self.jobs([self.single(state)])
            self.expect_tasks("12.tide 0 waiting")
        for state in "RSUE":
            self.jobs([self.single(state)])
            self.expect_tasks("12.tide 0 running")
        for state in "FM":  # as far as the server remembers
            self.jobs([self.single(state)])
            self.expect_tasks()

    def test_no_such_job(self):
        self.jobs([self.array(["R"], number="9", name=LONGER)])
        self.expect(self.query(), 0)

    def test_a_name_that_begins_another(self):
        self.jobs([self.array(["R"], number="9", name=LONGER), self.array(["Q", "X"])])
        self.expect_tasks("12[].tide 0 waiting")

    def test_a_job_that_was_submitted_twice(self):
        self.jobs([self.array(["X", "R"]), self.array(["Q", "X"], number="13")])
        self.expect_tasks("12[].tide 1 running", "13[].tide 0 waiting")

    def test_an_array_that_ends_between_two_commands(self):
        self.jobs([self.array(["R", "X"])], [])
        self.expect_tasks("12[].tide 0 waiting")  # the next query knows better

    def test_a_task_that_begins_or_is_requeued_between_two_commands(self):
        self.jobs([self.array(["Q", "R", "X"])], [self.array(["R", "Q", "X"])])
        self.expect_tasks("12[].tide 0 running", "12[].tide 1 waiting")

    def test_a_server_without_numbers_of_its_own(self):
        self.answers["qselect"] = [{"out": "12[3]\n12[]\n7\n"}]
        self.expect_tasks("12[] 3 running", "7 0 running")

    def test_without_a_whole_answer_it_fails(self):
        refused = {"err": "Connection refused\nqselect: cannot connect to server tide (errno=111)\n", "code": 111}
        lost = {"err": "qselect: End of File\n", "code": 183}
        tasks = {"jobs": [self.array(["R"])]}
        for answers in ([refused], [lost], [tasks, refused], [tasks, lost], [{"out": "12[0].tide\nPlease log in\n"}]):
            self.answers["qselect"] = answers
            self.assertNotEqual(self.query().returncode, 0, answers)

    def test_only_with_options_that_need_no_history(self):
        self.jobs([self.array(["R"])])
        self.query()
        for call in self.calls("qselect"):
            self.assertEqual([word for word in call["words"] if word.startswith("-")], ["-T", "-N", "-s"])


class PbsCancels(Pbs):
    def expect_cancelled(self, *jobs):
        self.expect(self.cancel(), 0)
        self.assertEqual([call["words"] for call in self.calls("qdel")], [[job] for job in jobs])

    def test_each_job_of_the_name(self):
        self.jobs([self.array(["R"]), self.single("Q", "13"), self.array(["R"], number="9", name=LONGER)])
        self.expect_cancelled("12[].tide", "13.tide")

    def test_nothing(self):
        self.jobs([self.single("E"), self.array(["R"], number="9", name=LONGER)])
        self.expect_cancelled()

    def test_a_job_that_ends_meanwhile(self):
        self.jobs([self.single("R", "2")], [self.single("R", "12")])
        for words, code in ((self.GONE + " 2.tide", 15001 % 256), ("Job has finished 2.tide", 15139 % 256)):
            self.answers["qdel"] = [{"err": f"qdel: {words}\n", "code": code}]
            self.expect_cancelled("2.tide")

    def test_a_job_that_may_not_be_deleted(self):
        self.jobs([self.array(["R"])])
        self.answers["qdel"] = [{"err": "qdel: Unauthorized Request  12[].tide\n", "code": 15007 % 256}]
        self.assertNotEqual(self.cancel().returncode, 0)

    def test_a_server_that_cannot_be_reached(self):
        refused = {"err": "qselect: cannot connect to server tide (errno=111)\n", "code": 111}
        self.answers["qselect"] = [refused]
        self.assertNotEqual(self.cancel().returncode, 0)
        self.answers["qselect"] = [{"jobs": [self.single("R")]}, refused]
        self.answers["qdel"] = [{"err": "qdel: End of File\n", "code": 183}]
        self.assertNotEqual(self.cancel().returncode, 0)


class PbsLimits(Pbs):
    def setUp(self):
        super().setUp()
        with open(os.path.join(HERE, "answers", "pbs", "qstat-Bf.txt"), encoding="utf-8") as file:
            self.server = file.read()

    def test_given(self):
        self.answers["qstat"] = [{"out": self.server}]
        self.expect(self.largest(), 0, "2500\n")
        self.assertEqual(self.calls("qstat")[0]["words"], ["-Bf"])

    def test_not_given(self):
        self.answers["qstat"] = [{"out": re.sub(" *max_array_size.*\n", "", self.server)}]
        self.expect(self.largest(), 0, "10000\n")

    def test_unknown(self):
        self.answers["qstat"] = [{"err": "qstat: cannot connect to server tide (errno=111)\n", "code": 1}]
        self.assertNotEqual(self.largest().returncode, 0)


class PbsRuns(Pbs):
    def test_the_task_of_its_index(self):
        for send in (os.kill, os.killpg):
            self.expect_stop(2, send, signal.SIGTERM, PBS_ARRAY_INDEX="2")

    def test_the_only_task(self):
        self.make(1)
        self.expect_stop(0, os.killpg, signal.SIGTERM)

    def test_and_leaves_as_its_task_does(self):
        self.expect_exit_codes(PBS_ARRAY_INDEX="0")


class Lsf(Bundle):
    COMMANDS = ("bsub", "bjobs", "bkill", "bparams")
    SUBMITTED = "Job <12> is submitted to default queue <normal>.\n"
    BUSY = "Cannot connect to LSF. Please wait ...\n"

    def setUp(self):
        self.start("lsf", self.COMMANDS)
        self.answers |= {"bsub": [{"out": self.SUBMITTED}], "bkill": [{}], "bparams": [{}]}
        self.jobs([self.array(["PEND"] * 4)])

    def jobs(self, *moments, code=255):
        """Lets each call of bjobs see the next of these lists of jobs."""
        self.answers["bjobs"] = [{"jobs": jobs, "code": code} for jobs in moments]

    @staticmethod
    def array(tasks, number="12", name=NAME):
        return {"id": number, "name": name, "tasks": tasks}


class LsfSubmits(Lsf):
    def test_the_script_as_its_input_with_options(self):
        self.expect(self.submit("-q", "short", "-W", "1:00"), 0, "12\n")
        (call,) = self.calls("bsub")
        self.assertEqual(call["words"], ["-q", "short", "-W", "1:00"])
        with open(self.path("job.sh"), encoding="utf-8") as file:
            self.assertEqual(call["input"], file.read())

    def test_directives_have_the_array_and_no_paths(self):
        for tasks in (1, 4):
            self.make(tasks)
            with open(self.path("job.sh"), encoding="utf-8") as file:
                directives = [line.rstrip() for line in file if line.startswith("#BSUB")]
            expected = [f'#BSUB -J "{NAME}[1-{tasks}]"', "#BSUB -n 3", '#BSUB -R "span[hosts=1]"']
            self.assertEqual(directives[:3], expected)
            self.assertEqual(directives[3:], ["#BSUB -o lsf-%J-%I.txt", "#BSUB -r", "#BSUB -wa USR1", "#BSUB -wt 2"])

    def test_where_the_report_is_looked_for(self):
        self.submit()
        self.assertEqual(self.calls("bsub")[0]["folder"], self.path("logs"))

    def test_without_variables_that_would_mislead(self):
        misleading = ("BSUB_QUIET", "BSUB_QUIET2", "BSUB_BLOCK", "BSUB_CHK_RESREQ")
        self.submit(**{name: "y" for name in misleading}, LSB_DEFAULTQUEUE="short")
        environment = self.calls("bsub")[0]["environment"]
        self.assertEqual([name for name in misleading if name in environment], [])
        self.assertEqual(environment["LSB_DEFAULTQUEUE"], "short")

    def test_the_number_among_other_words(self):
        answers = [
            {"out": "Project reef\n" + self.SUBMITTED},
            {"err": "Job <12> is submitted to queue <short>.\n"},  # BSUB_STDERR
            {"err": self.BUSY + self.BUSY, "out": self.SUBMITTED},
        ]
        for answer in answers:
            self.answers["bsub"] = [answer]
            self.expect(self.submit(), 0, "12\n")

    def test_and_waits_until_queries_know_it(self):
        earlier = self.array(["EXIT"], "11")
        self.jobs([earlier], [], [earlier, self.array(["PEND"] * 4)])
        self.expect(self.submit(), 0, "12\n")
        self.assertEqual(len(self.calls("bjobs")), 3)

    def test_and_does_not_wait_for_ever(self):
        self.jobs([])
        self.expect(self.submit(), 0, "12\n")
        seconds = sum(float(call["words"][0]) for call in self.calls("sleep"))
        self.assertTrue(5 < seconds < 30, seconds)  # a copy is 5 s old; peclet has a minute's patience

    def test_options_that_are_refused(self):
        refused = ["-J", "-Jmine", "-I", "-Ip", "-Is", "-ISs", "-IX", "-K", "-XF", "-pack", "-json", "-yaml", "-jsdl"]
        for option in (*refused, "-jsdl_strict", "-V", "-h"):
            self.expect(self.submit("-q", "short", option, "mine"), 2)
            self.assertEqual(self.calls("bsub"), [], option)

    def test_options_that_look_like_them(self):
        options = ["-Jd", "a sheared cell", "-i", "input", "-hl", "-k", "/tmp", "-is", "input"]
        self.expect(self.submit(*options), 0, "12\n")
        self.assertEqual(self.calls("bsub")[0]["words"], options)

    def test_how_it_fails(self):
        cases = [
            ("short: No such queue. Job not submitted.\n", 255, 1),
            ("Request aborted by esub. Job not submitted.\n", 255, 1),
            ("User permission denied. Job not submitted.\n", 0, 1),
            ("Request from non-LSF host rejected. Job not submitted.\n", 255, 1),
            (self.BUSY + "Bad resource requirement syntax. Job not submitted.\n", 255, 1),
            ("Connection refused by server. Job not submitted.\n", 255, 1),
            ("sh: bsub: not found\n", 127, 1),
            ("Contacting batch daemon: Communication timeout. Job not submitted.\n", 255, 75),
            (
                "Failed in an LSF library call: Failed in sending/receiving a message: Connection reset by peer.\n",
                255,
                75,
            ),
            ("Failed in an LSF library call: Connection is lost. Job not submitted.\n", 255, 75),
            ("Batch protocol error. Job not submitted.\n", 255, 75),
            ("XDR encode/decode error. Job not submitted.\n", 255, 75),
            (self.BUSY, 143, 75),  # killed
            ("", 0, 75),  # a success without a number
        ]
        for words, code, expected in cases:
            self.answers["bsub"] = [{"err": words, "code": code}]
            done = self.submit()
            self.expect(done, expected)
            self.assertIn(words, done.stderr)

    def test_how_to_stay_within_a_limit(self):
        for words in ("Job array index too large", "Pending job threshold reached"):
            self.answers["bsub"] = [{"err": f"{words}. Job not submitted.\n", "code": 255}]
            done = self.submit()
            self.expect(done, 1)
            self.assertIn("--largest-array N", done.stderr)


class LsfQueries(Lsf):
    def test_every_state_of_a_task(self):
        waiting, running = ["PEND", "PSUSP", "WAIT", "PROV"], ["RUN", "USUSP", "SSUSP", "UNKWN"]
        ended = ["DONE", "EXIT", "ZOMBI"]
        self.jobs([self.array(waiting + running + ended)])
        words = ["waiting"] * 4 + ["running"] * 4 + ["ended"] * 3
        self.expect_tasks(*[f"12 {index} {word}" for index, word in enumerate(words)])

    def test_a_number_with_its_index(self):
        self.answers["bjobs"] = [{"out": "1234567890[1] 1 RUN   \n1234567890[12] 12 PEND  \n"}]  # LSB_BJOBS_DISPLAY_ENH
        self.expect_tasks("1234567890 0 running", "1234567890 11 waiting")

    def test_no_such_job(self):
        for code in (255, 0):
            self.jobs([self.array(["RUN"], "9", LONGER)], code=code)
            self.expect(self.query(), 0)

    def test_a_name_that_begins_another(self):
        self.jobs([self.array(["RUN"], "9", LONGER), self.array(["DONE", "PEND"])])
        self.expect_tasks("12 0 ended", "12 1 waiting")

    def test_a_job_that_was_submitted_twice_and_one_that_runs_again(self):
        self.jobs([self.array(["RUN"]), self.array(["PEND"], "13"), self.array(["ZOMBI"], "13")])
        self.expect_tasks("12 0 running", "13 0 waiting", "13 0 ended")

    def test_an_answer_after_some_attempts(self):
        self.answers["bjobs"] = [{"err": self.BUSY + "LSF is down. Please wait ...\n", "out": "12 1 RUN\n"}]
        self.expect_tasks("12 0 running")

    def test_without_a_whole_answer_it_fails(self):
        down = "LSF is down. Please wait ...\n"
        answers = [
            {"err": down, "code": 255},
            {"err": down + "Request from non-LSF host rejected\n", "code": 255},
            {"err": "Failed in an LSF library call: Communication time out\n", "code": 255, "out": "12 1 RUN\n"},
            {"err": "batch system daemon not responding ... still trying\n", "code": 143},
            {"err": "Failed in an LSF library call: LIM is down; try later\n", "code": 0, "out": "12 1 RUN\n"},
            {"out": "12 1 RUN\n", "code": 137},
            {"out": ""},
            {"err": f"Job <{LONGER}> is not found\n", "code": 255},  # of which nothing was asked
            {"out": "12 0 RUN\n"},
            {"out": "JOBID JOBINDEX STAT\n12 1 RUN\n"},
        ]
        for answer in answers:
            self.answers["bjobs"] = [answer]
            self.assertNotEqual(self.query().returncode, 0, answer)

    def test_with_a_format_of_its_own(self):
        self.query(LSB_BJOBS_FORMAT="user")
        (call,) = self.calls("bjobs")
        self.assertEqual(call["words"], ["-a", "-noheader", "-o", "jobid jobindex stat", "-J", NAME])


class LsfCancels(Lsf):
    def test_all_jobs_of_the_name(self):
        self.answers["bkill"] = [{"out": "Job <12[1]> is being terminated\nJob <13[1]> is being terminated\n"}]
        self.expect(self.cancel(), 0)
        self.assertEqual([call["words"] for call in self.calls("bkill")], [["-J", NAME, "0"]])

    def test_nothing(self):
        for words in (f"Job <{NAME}> is not found", "No matching job found", "No unfinished job found"):
            self.answers["bkill"] = [{"err": words + "\n", "code": 255}]
            self.expect(self.cancel(), 0)

    def test_a_task_that_ends_meanwhile(self):
        finished = "Job <12[1]>: Job has already finished\n"
        answer = {"out": "Job <12[2]> is being terminated\n", "err": self.BUSY + finished, "code": 255}
        self.answers["bkill"] = [answer]
        self.expect(self.cancel(), 0)

    def test_a_job_that_may_not_be_killed_or_a_cluster_that_is_down(self):
        for words in ("Job <12[1]>: User permission denied\nJob <12[2]>: Job has already finished\n", self.BUSY, ""):
            self.answers["bkill"] = [{"err": words, "code": 255}]
            self.assertNotEqual(self.cancel().returncode, 0, words)


class LsfLimits(Lsf):
    def setUp(self):
        super().setUp()
        with open(os.path.join(HERE, "answers", "lsf", "bparams-a.txt"), encoding="utf-8") as file:
            self.parameters = file.read()

    def test_given(self):
        self.answers["bparams"] = [{"out": self.parameters}]
        self.expect(self.largest(), 0, "4000\n")
        self.assertEqual(self.calls("bparams")[0]["words"], ["-a"])

    def test_not_given(self):  # peclet takes 1000, which is LSF's as well
        self.answers["bparams"] = [{"out": self.parameters.replace("MAX_JOB_ARRAY_SIZE", "MAX_OTHER")}]
        self.assertNotEqual(self.largest().returncode, 0)

    def test_unknown(self):
        self.answers["bparams"] = [{"err": self.BUSY, "code": 255}]
        self.assertNotEqual(self.largest().returncode, 0)


class LsfRuns(Lsf):
    def test_the_task_of_its_index_from_0(self):
        for number in (signal.SIGINT, signal.SIGTERM, signal.SIGUSR1, signal.SIGUSR2):
            for send in (os.kill, os.killpg):
                note = self.expect_stop(2, send, number, LSB_JOBINDEX="3")
                self.assertTrue(note["usr2"], "SIGUSR2 would end the task")

    def test_and_leaves_as_its_task_does(self):
        self.expect_exit_codes(LSB_JOBINDEX="1")


if __name__ == "__main__":
    unittest.main()
