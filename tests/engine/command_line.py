#!/usr/bin/python3
"""command_line.py ENGINE

Tests the command line of peclet-engine. Bad arguments end with exit code 2 and are named. A run ends with
a summary on standard error, whose numbers are recomputed here from the result. Results begin with the
means. Waiting threads sleep unless the environment says otherwise.
"""
import json
import math
import os
import socket
import subprocess
import sys
import tempfile
import time

NO_CARD = "no card: "
SCENE = {
    "particles": {"count": 40, "density": 0.1, "species": [{"radius": 1}]},
    "volume_fraction": 0.4,
    "fluid": {"viscosity": 0.1, "thermal_energy": 0.02},
    "flow": {"shear_rate": 2},
    "contact": {"normal_stiffness": 1e4},
    "lubrication": {"form": "kim-karrila", "inner_gap": 0.03, "outer_gap": 0.1},
    "integrator": {"method": "explicit", "timestep": 0.002},
    "guard": {"largest_overlap": 0.2, "largest_displacement": 0.2},
    "duration": {"equilibration": {"time": 0.1}, "production": {"time": 0.64}},
}


def bad_arguments(engine, scene):
    for arguments, named in [
        ([], "peclet-engine: a verb is missing; `peclet-engine --help` lists them\n"),
        (["run"], "peclet-engine: run: scene: is missing: Scene, a JSON file; `peclet-engine run --help` says more\n"),
        (["frobnicate"], "peclet-engine: frobnicate: there is no such verb; `peclet-engine --help` lists them\n"),
        ([scene, "run"], "the verb goes first: peclet-engine run "),
        (["run", scene, "--sead", "1"], "run: --sead: there is no such option"),
        (["run", scene, "-j", "1"], "run: -j: there is no such option"),
        (["run", scene, "--output"], "run: --output: must have one value"),
        (["run", scene, "--seed", "-1"], '"-1" must be a whole number from 0 to 18446744073709551615'),
        (["run", scene, "--seed", "1.5"], '"1.5"'),
        (["run", scene, "--seed", "18446744073709551616"], '"18446744073709551616"'),
        (["run", scene, "--seed", ""], '""'),
        (["run", scene, "--threads", "0"], '--threads: "0" must be a whole number from 1 to 1024'),
        (["run", scene, "--threads", "two"], '"two" must be a whole number'),
        (["run", scene, "--seeds", "1..2"], "--seeds: 1..2: needs --output"),
        (["run", scene, "--seeds", "2..1"], "--seeds: 2..1: must be FIRST..LAST"),
        (["run", scene, "--seeds", "1-2"], "--seeds: 1-2: must be FIRST..LAST"),
        (["run", scene, "--seeds", "0..1000000"], "1000000 seeds at most"),
        (["run", scene, "--seeds", "1..2", "--seed", "1"], "--seed: cannot stand beside --seeds"),
        (["run", scene, "--seeds", "1..2", "--extend", "x"], "cannot stand beside"),
        (["run", scene, "--device", "gpu"], '--device: "gpu" must be one of none, cuda, auto, emulated'),
        (["run", scene, "--device", "cuda"], "--device: cuda: no card"),
        (["trajectory", "t.gsd", "--format", "pdb"], '--format: "pdb" must be one of lammps, xyz'),
        (["snapshot", "t.gsd", "--output", "t.png", "--colour", "blue"], '"blue" must be one of species, '),
    ]:
        done = subprocess.run([engine, *arguments], capture_output=True, text=True)
        assert (done.returncode, done.stdout) == (2, ""), f"{arguments}: exit {done.returncode}, {done.stdout!r}"
        assert named in done.stderr, f"{arguments}: {done.stderr!r} does not say {named!r}"
        assert done.stderr.count("\n") == 1 and done.stderr.startswith("peclet-engine: "), done.stderr
    with tempfile.TemporaryDirectory() as folder:
        campaign = os.path.join(folder, "campaign.json")
        with open(campaign, "w") as file:
            json.dump({"name": "a", "scene": SCENE}, file)
        done = subprocess.run([engine, "run", campaign], capture_output=True, text=True)
        assert done.returncode == 2 and "is a campaign" in done.stderr, done.stderr
    for arguments in (["--help"], ["run", "--help"], ["--version"], ["version"]):
        assert subprocess.run([engine, *arguments], capture_output=True).returncode == 0, arguments


def standard_error(series):
    """Returns the standard error of a correlated series. The variance of the mean is multiplied by 1 + 2
    times the sum of correlations before the first that is not positive."""
    n = len(series)
    mean = math.fsum(series) / n
    products = [math.fsum((a - mean) * (b - mean) for a, b in zip(series, series[lag:])) / n for lag in range(n)]
    inefficiency = 1
    for product in products[1:]:
        if product <= 0:
            break
        inefficiency += 2 * product / products[0]
    return math.sqrt(products[0] * inefficiency / (n - 1))


def summaries(engine, scene, folder):
    run = [engine, "run", scene, "--seed", "18446744073709551615"]
    done = subprocess.run(run, capture_output=True, text=True, check=True)
    result = json.loads(done.stdout)
    assert result["seed"] == 2**64 - 1
    keys = [key for key, _ in json.loads(done.stdout, object_pairs_hook=lambda pairs: pairs)]
    assert keys[-1] == "blocks" and "mean" in keys[:6], keys
    assert sorted(keys) == sorted(result)
    lines = done.stderr.splitlines()
    assert 8 <= len(lines) <= 12, done.stderr
    text = {line.split()[0]: line for line in lines}

    def shown(name):
        return f"{result['mean'][name]:.4g} ± {standard_error(result['blocks'][name]):.2g}"

    for line, name in [
        ("viscosity", "relative_viscosity"),
        ("viscosity", "relative_viscosity_pair"),
        ("N1,", "first_normal_difference"),
        ("N1,", "second_normal_difference"),
        ("pressure", "pressure"),
        ("contacts", "contacts_per_particle"),
    ]:
        assert shown(name) in text[line], f"{name} is {shown(name)}: {text[line]}"
    assert "50 + 320 explicit" in text["steps"] and "strain of 0.2 + 1.28" in text["steps"], text["steps"]
    assert "standard output" in text["result"] and str(2**64 - 1) in text["result"], text["result"]
    assert sum(line.startswith("warning ") for line in lines) == len(result["warnings"]), done.stderr

    path = os.path.join(folder, "result.json")
    done = subprocess.run([*run, "--output", path], capture_output=True, text=True, check=True)
    assert done.stdout == "" and path in done.stderr.splitlines()[-1], done.stderr
    with open(path) as f:
        assert json.load(f)["mean"] == result["mean"]
    done = subprocess.run([*run, "--output", path, "--quiet"], capture_output=True, text=True, check=True)
    assert done.stdout + done.stderr == "", done.stderr


def seeds(engine, scene, folder):
    largest = 2**64 - 1

    def path(*parts):
        return os.path.join(folder, ".".join(parts))

    def results(name, *options):
        arguments = ["--seeds", f"{largest - 1}..{largest}", "--output", path(name, "json"), "--quiet", *options]
        done = subprocess.run([engine, "run", scene, *arguments], capture_output=True, text=True, check=True)
        without_a_card = done.stderr.startswith("--device: no card: ") and done.stderr.count("\n") == 1
        assert done.stdout == "" and (done.stderr == "" or without_a_card and "auto" in options), done.stderr
        found = []
        for seed in (largest - 1, largest):
            with open(path(name, str(seed), "json")) as file:
                found.append(json.load(file))
            assert found[-1].pop("seed") == seed
            found[-1].pop("cost")
        return found

    two = results("some")
    assert two[0]["final_state_sha256"] != two[1]["final_state_sha256"]
    alone = subprocess.run([engine, "run", scene, "--seed", str(largest)], capture_output=True, text=True, check=True)
    assert json.loads(alone.stdout)["mean"] == two[1]["mean"]
    assert results("any", "--device", "auto") == two, "a machine without a card"


def stopped_seeds(engine, folder):
    """Stops a run of two seeds, of which the second has not begun then."""
    scene = os.path.join(folder, "longer.json")
    with open(scene, "w") as file:
        json.dump({**SCENE, "duration": {**SCENE["duration"], "production": {"time": 10000}}}, file)
    paths = {name: os.path.join(folder, f"stopped{name}") for name in (".json", ".ckpt")}
    arguments = ["--seeds", "4..5", "--output", paths[".json"], "--checkpoint", paths[".ckpt"]]
    with subprocess.Popen([engine, "run", scene, *arguments], stderr=subprocess.PIPE, text=True) as process:
        time.sleep(1)
        process.terminate()
        said = process.stderr.read()
    assert process.returncode == 75 and f"continues from {os.path.join(folder, 'stopped.4.ckpt')}" in said, said
    assert sorted(name for name in os.listdir(folder) if name.startswith("stopped")) == ["stopped.4.ckpt"]


def devices(engine):
    def serving(device):
        environment = os.environ | {"PECLET_DEVICE": device}
        done = subprocess.run([engine, "serve"], stdin=subprocess.DEVNULL, capture_output=True, env=environment)
        return done.returncode, done.stderr.decode()

    code, said = serving("cuda")
    assert code == 2 and said.startswith("peclet-engine: PECLET_DEVICE: cuda: " + NO_CARD), said
    allowed = "must be cuda or auto; or emulated, for tests\n"
    assert serving("gpu") == (2, "peclet-engine: PECLET_DEVICE: gpu: " + allowed), serving("gpu")


def emulated(engine, folder):
    """Runs scenes on the processor as a card. What a card cannot do is refused, and nothing is written."""
    ours = os.path.join(folder, "emulated")
    os.mkdir(ours)
    scene = os.path.join(ours, "scene.json")
    usual = {
        **SCENE,
        "integrator": {"method": "implicit"},
        "duration": {"equilibration": {"time": 0.1}, "production": {"time": 0.3}},
    }
    run = [engine, "run", scene, "--device", "emulated", "--output", os.path.join(ours, "out.json")]
    for patch, named in [
        ({"integrator": SCENE["integrator"]}, '/integrator/method: "explicit": must be implicit for a card'),
        ({"flow": {"oscillation": {"amplitude": 1, "frequency": 1}}}, "/flow: {"),
        ({"observables": ["fabric"]}, '/observables: ["fabric"]: must be absent: '),
        ({"box": {"height": 8}}, '/box: {"height":8}: must be absent: a cube for a card'),
        (
            {"particles": {**SCENE["particles"], "count": 4097}},
            "/particles/count: 4097: must be at most 4096 for a card",
        ),
    ]:
        with open(scene, "w") as file:
            json.dump({**usual, **patch}, file)
        options = ["--seeds", "1..3", "--checkpoint", os.path.join(ours, "out.ckpt")]
        done = subprocess.run([*run, *options], capture_output=True, text=True)
        assert (done.returncode, done.stdout) == (2, ""), done
        assert done.stderr.startswith(f"peclet-engine: {scene}: {named}") and done.stderr.count("\n") == 1, done.stderr
        assert os.listdir(ours) == ["scene.json"], os.listdir(ours)
    with open(scene, "w") as file:
        json.dump(usual, file)
    subprocess.run([*run, "--seeds", "1..2", "--quiet"], check=True)
    subprocess.run([*run, "--seed", "2", "--quiet"], check=True)
    results = []
    for name in ("out.1.json", "out.2.json", "out.json"):
        with open(os.path.join(ours, name)) as file:
            results.append(json.load(file))
        assert results[-1].pop("cost") and results[-1]["engine"]["device"] == "emulated"
        assert results[-1]["engine"]["instruction_set"].startswith("emulated; ")
    assert results[0]["mean"] != results[1]["mean"] and results[1] == results[2]


def waiting(engine):
    def environment_of_engine(wishes):
        environment = {k: v for k, v in os.environ.items() if k not in ("OMP_WAIT_POLICY", "GOMP_SPINCOUNT")} | wishes
        ours, theirs = socket.socketpair()
        with ours, theirs, subprocess.Popen([engine, "serve"], stdin=theirs, env=environment) as process:
            assert ours.recv(4) == b"PCF1"  # the engine is running
            with open(f"/proc/{process.pid}/environ", "rb") as f:
                found = dict(entry.split("=", 1) for entry in f.read().decode().split("\0") if "=" in entry)
            ours.shutdown(socket.SHUT_RDWR)
        return {k: found.get(k) for k in ("OMP_WAIT_POLICY", "GOMP_SPINCOUNT")}

    usual = environment_of_engine({})
    assert usual["OMP_WAIT_POLICY"] is None and int(usual["GOMP_SPINCOUNT"]) < 300000, usual
    for wishes in ({"GOMP_SPINCOUNT": "7"}, {"OMP_WAIT_POLICY": "active"}):
        found = environment_of_engine(wishes)
        assert {k: v for k, v in found.items() if v} == wishes, found


def main():
    engine = os.path.abspath(sys.argv[1])
    with tempfile.TemporaryDirectory() as folder:
        scene = os.path.join(folder, "scene.json")
        with open(scene, "w") as f:
            json.dump(SCENE, f)
        bad_arguments(engine, scene)
        summaries(engine, scene, folder)
        seeds(engine, scene, folder)
        stopped_seeds(engine, folder)
        emulated(engine, folder)
    devices(engine)
    waiting(engine)


if __name__ == "__main__":
    main()
