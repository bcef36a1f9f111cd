#!/usr/bin/env python3
"""Mutation testing of the committed source: which changes to src/ does no test notice?

    python3 .ci/mutants.py              # hours
    python3 .ci/mutants.py src/trajectory.rs

Each mutant first meets the tests of its file, and if it survives, all other tests. The script fails
unless the survivors are those in .ci/mutants.txt, which gives the reasons. It needs `cargo install
cargo-mutants`.
"""

import json
import os
import re
import shutil
import subprocess
import sys
from collections import Counter
from fnmatch import fnmatch
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
SURVIVORS = ROOT / ".ci/mutants.txt"
COPY = ROOT / "target/mutants/0"

# Without `sines`, which tests one file, and `batch`, which takes minutes without optimization.
OTHERS = sorted({path.stem for path in (ROOT / "tests").glob("*.rs")} - {"sines"})
ROUNDS = [
    (["src/physics/control*"], ["control"]),
    (
        ["src/arithmetic*", "src/math*", "src/physics*"],
        ["step_error", "parity", "physics", "pendulum", "trigonometry"],
    ),
    (["src/math/sines/correctly_rounded*"], ["sines"]),
    (["src/trajectory.rs"], ["trajectory"]),
    (["src/batch*", "src/math/lanes.rs"], ["stability"]),
    (["src/env*", "src/render*"], ["check_env", "env", "display", "render"]),
    (["src/*"], ["acrobot", "validation", "seeding", "snapshot", "trajectory"]),
    (["src/*"], OTHERS),
    (["src/batch*", "src/math/lanes.rs"], ["batch"]),
    (["src/*"], ["properties"]),
]
# Without optimization, and incrementally, the crate and a test compile in a twentieth of the time;
# dependencies stay as they are.
CARGO = [
    "--config=profile.dev.package.acrobot.opt-level=0",
    "--config=profile.dev.package.acrobot.debug=false",
    "--config=profile.dev.incremental=true",
    "--config=profile.dev.codegen-units=16",
]


def run(*command, **options):
    return subprocess.run(command, **({"check": True, "cwd": COPY} | options))


def play(files, tests, done):
    """Runs a round. Returns the outcome of each mutant that was not done."""
    output = COPY / "mutants.out"
    shutil.rmtree(output, ignore_errors=True)
    output.mkdir()
    for name in ("caught", "missed", "timeout", "unviable"):
        names = done if name == "caught" else []
        (output / f"{name}.txt").write_text("".join(f"{mutant}\n" for mutant in names))
    options = ["--in-place", "--iterate", "--no-times", "--colors=never", "--timeout=300"]
    options += [f"--file={file}" for file in files]
    # `--lib` tests the rotations that this machine does not use.
    selected = ["--cargo-arg=--lib"] + [f"--cargo-arg=--test={test}" for test in tests]
    options += ["--test-package=properties"] if tests == ["properties"] else selected
    options += [f"--cargo-arg={option}" for option in CARGO]
    # It uses the dependencies that are built in target/.
    environment = {**os.environ, "CARGO_TARGET_DIR": str(ROOT / "target")}
    run("cargo", "mutants", *options, env=environment, check=False)
    outcomes = json.loads((output / "outcomes.json").read_text())["outcomes"]
    summaries = [(each["scenario"], each["summary"]) for each in outcomes]
    if any(scenario == "Baseline" and summary != "Success" for scenario, summary in summaries):
        sys.exit("the tests fail without a mutant")
    return {
        scenario["Mutant"]["name"]: summary
        for scenario, summary in summaries
        if scenario != "Baseline"
    }


def expected(files):
    survivors = Counter()
    for line in SURVIVORS.read_text().splitlines():
        name, _, count = line.partition(" ×")
        if name.split(":")[0] in files:
            survivors[name] += int(count or 1)
    return survivors


def main():
    listing = ["cargo", "mutants", "--list", "--json", *(f"--file={x}" for x in sys.argv[1:])]
    mutants = json.loads(run(*listing, cwd=ROOT, stdout=subprocess.PIPE).stdout)
    files = {mutant["name"]: mutant["file"] for mutant in mutants}
    if not files:
        sys.exit(f"files must be below src/ and have mutants, got {' '.join(sys.argv[1:])}")
    if not COPY.exists():
        run("git", "clone", "--quiet", ROOT, COPY, cwd=ROOT)
    # This also removes a mutant that an interrupted run left, and works with a detached HEAD.
    run("git", "fetch", "--quiet", "origin", "HEAD")
    run("git", "reset", "--quiet", "--hard", "FETCH_HEAD")
    became = {}
    for patterns, tests in ROUNDS:
        done = [name for name, summary in became.items() if summary != "MissedMutant"]
        left = {file for name, file in files.items() if name not in done}
        left = {file for file in left if any(fnmatch(file, pattern) for pattern in patterns)}
        if left:
            became |= play(sorted(left), tests, done)

    # cargo-mutants was killed, or the committed files have other mutants than the files here.
    if unknown := files.keys() - became.keys():
        none = f"{len(unknown)} of {len(files)} have none: {min(unknown)} …"
        sys.exit(f"each mutant must have an outcome, {none}")
    counts = Counter(became.values())
    caught, missed = counts["CaughtMutant"] + counts["Timeout"], counts["MissedMutant"]
    share = f"{caught / max(caught + missed, 1):.1%} of {caught + missed} mutants were caught"
    print(f"{share}; {counts['Unviable']} did not compile")
    # Without line and column, which other changes move.
    missed = (name for name, summary in became.items() if summary == "MissedMutant")
    survivors = Counter(re.sub(r":\d+:\d+", "", name) for name in missed)
    known = expected(files.values())
    for name in (survivors - known).elements():
        print(f"survives, and is not in {SURVIVORS.name}: {name}")
    for name in (known - survivors).elements():
        print(f"does not survive, and is in {SURVIVORS.name}: {name}")
    if survivors != known:
        sys.exit(1)


main()
