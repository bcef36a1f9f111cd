#!/usr/bin/env python3
"""Mutation testing of the committed source: which changes to src/ does no test notice?

    python3 .ci/mutants.py              # three hours on two cores
    python3 .ci/mutants.py src/trajectory.rs

Each mutant first meets the tests of its file, and if it survives, all other tests. The script fails unless the
survivors are those in .ci/mutants.txt, which gives the reasons. It needs `cargo install cargo-mutants`.
"""

import json
import os
import re
import shutil
import subprocess
import sys
from collections import Counter
from concurrent.futures import ThreadPoolExecutor
from fnmatch import fnmatch
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
SURVIVORS = ROOT / ".ci/mutants.txt"
SHARDS = os.cpu_count() if len(sys.argv) == 1 else 1

# Without `sines`, which tests one file, and `batch`, which takes minutes without optimization.
OTHERS = sorted({path.stem for path in (ROOT / "tests").glob("*.rs")} - {"sines"})
ROUNDS = [
    (["src/physics/control*"], ["control"]),
    (["src/arithmetic*", "src/math*", "src/physics*"], ["step_error", "parity", "physics", "pendulum", "trigonometry"]),
    (["src/math/sines/correctly_rounded*"], ["sines"]),
    (["src/trajectory.rs"], ["trajectory"]),
    (["src/batch*", "src/math/lanes.rs"], ["stability"]),
    (["src/env*", "src/render*"], ["check_env", "env", "display", "render"]),
    (["src/*"], ["acrobot", "validation", "seeding", "snapshot", "trajectory"]),
    (["src/*"], OTHERS),
    (["src/batch*", "src/math/lanes.rs"], ["batch"]),
    (["src/*"], ["properties"]),
]
# Without optimization, and incrementally, the crate and a test compile in a twentieth of the time; dependencies stay as they are.
CARGO = [
    "--config=profile.dev.package.acrobot.opt-level=0",
    "--config=profile.dev.package.acrobot.debug=false",
    "--config=profile.dev.incremental=true",
    "--config=profile.dev.codegen-units=16",
]


def copy(shard):
    """Clones the repository for a shard, or updates the clone."""
    folder = ROOT / f"target/mutants/{shard}"
    if not folder.exists():
        subprocess.run(["git", "clone", "--quiet", ROOT, folder], check=True)
    # This also removes a mutant that an interrupted run left, and works with a detached HEAD.
    subprocess.run(["git", "fetch", "--quiet", "origin", "HEAD"], cwd=folder, check=True)
    subprocess.run(["git", "reset", "--quiet", "--hard", "FETCH_HEAD"], cwd=folder, check=True)
    return folder


def play(folder, shard, files, tests, done):
    """Runs one shard of a round. Returns the outcome of each mutant that was not done."""
    output = folder / "mutants.out"
    shutil.rmtree(output, ignore_errors=True)
    output.mkdir()
    for name in ("caught", "missed", "timeout", "unviable"):
        (output / f"{name}.txt").write_text("".join(f"{mutant}\n" for mutant in done) if name == "caught" else "")
    options = ["--in-place", "--iterate", f"--shard={shard}/{SHARDS}", "--no-times", "--colors=never", "--timeout=300"]
    options += [f"--file={file}" for file in files]
    # `--lib` tests the rotations that this machine does not use.
    selected = ["--cargo-arg=--lib"] + [f"--cargo-arg=--test={test}" for test in tests]
    options += ["--test-package=properties"] if tests == ["properties"] else selected
    options += [f"--cargo-arg={option}" for option in CARGO]
    # A single shard uses the dependencies that are built in target/.
    environment = {**os.environ, "CARGO_TARGET_DIR": str(ROOT / "target" if SHARDS == 1 else folder / "target")}
    subprocess.run(["cargo", "mutants", *options], cwd=folder, env=environment)
    outcomes = json.loads((output / "outcomes.json").read_text())["outcomes"]
    baseline = [outcome["summary"] for outcome in outcomes if outcome["scenario"] == "Baseline"]
    if baseline not in ([], ["Success"]):
        sys.exit("the tests fail without a mutant")
    return {outcome["scenario"]["Mutant"]["name"]: outcome["summary"] for outcome in outcomes if outcome["scenario"] != "Baseline"}


def main():
    chosen = [f"--file={file}" for file in sys.argv[1:]]
    mutants = json.loads(subprocess.check_output(["cargo", "mutants", "--list", "--json", *chosen], cwd=ROOT))
    files = {mutant["name"]: mutant["file"] for mutant in mutants}
    if not files:
        sys.exit(f"files must be below src/ and have mutants, got {' '.join(sys.argv[1:])}")
    folders = [copy(shard) for shard in range(SHARDS)]
    became = {}
    for patterns, tests in ROUNDS:
        done = [name for name, summary in became.items() if summary != "MissedMutant"]
        left = {file for name, file in files.items() if name not in done and any(fnmatch(file, pattern) for pattern in patterns)}
        if left:
            with ThreadPoolExecutor() as pool:
                shards = [pool.submit(play, folder, shard, sorted(left), tests, done) for shard, folder in enumerate(folders)]
            for shard in shards:
                became |= shard.result()

    # cargo-mutants was killed, or the committed files have other mutants than the files here.
    if unknown := files.keys() - became.keys():
        sys.exit(f"each mutant must have an outcome, {len(unknown)} of {len(files)} have none: {min(unknown)} …")
    counts = Counter(became.values())
    caught, missed = counts["CaughtMutant"] + counts["Timeout"], counts["MissedMutant"]
    print(f"{caught} of {caught + missed} mutants were caught, {caught / max(caught + missed, 1):.1%}; {counts['Unviable']} did not compile")
    # Without line and column, which other changes move.
    survivors = Counter(re.sub(r":\d+:\d+", "", name) for name, summary in became.items() if summary == "MissedMutant")
    lines = SURVIVORS.read_text().splitlines()
    expected = Counter(line for line in lines if line.split(":")[0] in files.values())
    for name in (survivors - expected).elements():
        print(f"survives, and is not in {SURVIVORS.name}: {name}")
    for name in (expected - survivors).elements():
        print(f"does not survive, and is in {SURVIVORS.name}: {name}")
    if survivors != expected:
        sys.exit(1)


main()
