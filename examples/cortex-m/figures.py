"""Measures what the crate costs on microcontrollers, and compares it with the tables in
`docs/embedded-figures.md`.

The firmware counts instructions, stack and RAM. Flash is that of `minimal` minus that of the same
firmware without an acrobot, or without an addition to it. `cycles.py` estimates the cycles per
instruction. Each figure is the same in every run, the estimates too.
"""

import argparse
import collections
import difflib
import functools
import os
import pathlib
import re
import subprocess
import sys

import cycles

DOCUMENT = pathlib.Path("../../docs/embedded-figures.md")
M4F = "thumbv7em-none-eabihf"
TUNED = "-C target-cpu=cortex-m4"
ARITHMETICS = {name: f"`{name.title()}`" for name in ("fast", "micro", "reference", "portable")}
ROWS = {
    "step": "instructions per step, with observation, end test and resets",
    "cycles": "cycles per step, estimated",
    "tuned": f"cycles per step with `{TUNED}`, estimated",
    "rate": "steps per second at 64 MHz with that, estimated",
    "draw": "instructions per frame of 128×64 pixels",
    "redraw": "instructions per frame if only what moved is drawn",
    "flash": "flash of the crate with seeding, bytes",
    "physics": "flash of the pendulum alone, bytes",
    "size": "RAM of an `Acrobot`, bytes",
    "stack": "stack of a step, bytes",
    "learn": "instructions per step of training",
    "training": "training until the mean return of 100 episodes is −100, millions of instructions",
    "decision": "instructions per decision of a perceptron with 64 and 64 units",
    "decision_ram": "RAM of the whole firmware that plays this perceptron, bytes",
    "ram": "RAM of the whole firmware that trains, bytes",
}
M7 = "-C target-cpu=cortex-m7 -C link-arg=--defsym=RAM_ORIGIN=0x60000000"
CORE_COLUMNS = ARITHMETICS | {
    "fast_soft_floats": "`Fast`, soft-floats",
    "micro_soft_floats": "`Micro`, soft-floats",
}
Core = collections.namedtuple(
    "Core", "words target has_fpu rustflags machine", defaults=[False, "", ""]
)
# These rows exclude the first table, which has more figures of the Cortex-M4F.
CORES = {
    "m0": Core("Cortex-M0", "thumbv6m-none-eabi"),
    "m3": Core("Cortex-M3", "thumbv7m-none-eabi"),
    "m7": Core("Cortex-M7 with `f64`", M4F, True, M7, "mps2-an500"),
    "m33": Core("Cortex-M33 with FPU", "thumbv8m.main-none-eabihf", True),
    "rv32i": Core("RV32I", "riscv32i-unknown-none-elf"),
    "rv32imc": Core("RV32IMC", "riscv32imc-unknown-none-elf"),
    "rv32imafc": Core("RV32IMAFC", "riscv32imafc-unknown-none-elf", True),
}
CORE_ROWS = {name: f"{core.words}, `{core.target}`" for name, core in CORES.items()}
LIMITS = {"10_Nm": "10 N m, 1,000 initial states"}
LIMITS |= {f"{limit}_Nm": f"{limit} N m, 100" for limit in (2, 1)}
BALANCE = {
    "plan_s": "time of the plan, s",
    "plan_millions": "planning, millions of instructions",
    "uncaught": "not caught within 100 s",
    "catch_mean_s": "mean time to catch, s",
    "catch_longest_s": "longest time to catch, s",
    "error_mrad": "largest error of an angle while held, mrad",
    "instructions_mean": "instructions per decision, mean",
    "instructions_most": "instructions per decision, most",
    "flash_bytes": "flash of the whole firmware, bytes",
    "ram_bytes": "RAM of the whole firmware, bytes",
}
CONTROLLED = {name: ARITHMETICS[name] for name in ("fast", "reference")}
CONTROL = {
    "linearize": "`linearize`",
    "linearize_step": "`linearize_step`",
    "lqr": "`lqr`",
    "torque": "`difference` and `Lqr::torque`",
    "inverse_dynamics": "`inverse_dynamics`",
    "velocities": "`velocities`",
    "estimator": "`Estimator` with friction, a measurement and a step",
    "estimator_params": "the same with 10 parameters",
}
ADDITIONS = {
    "message": "flash of `set_params`, and `message` of its error",
    "display": "flash of `set_params`, and `Display` of its error",
    "serde": "flash of saving and loading with serde, postcard and a CRC",
    "lqr": "flash of `linearize_step`, `lqr`, `deviation` and the regulator's torque",
    "lqr_stack": "stack of `lqr`",
}
REAL = {
    "upright_ms": "upright from hanging, after ms",
    "again_ms": "upright after a push of 6 rad/s, after ms",
    "tick_instructions": "instructions of a tick, most",
    "slices": "slices of planning in 10 s",
    "slice_ticks": "ticks during a slice, most",
    "flash_bytes": "flash of the whole firmware, bytes",
    "ram_bytes": "RAM of the whole firmware, bytes",
}
ADDED, UPRIGHT = "what a firmware adds to an acrobot", "instructions at 100 Hz, upright"


def run(*command, rustflags="", machine="", minimal=""):
    environment = os.environ | {"RUSTFLAGS": rustflags, "MINIMAL": minimal}
    if machine:
        runner = f"../../.cargo/qemu arm {machine}"
        environment["CARGO_TARGET_THUMBV7EM_NONE_EABIHF_RUNNER"] = runner
    done = subprocess.run(command, stdout=subprocess.PIPE, text=True, env=environment)
    if done.returncode != 0:
        sys.exit(f"{done.stdout}failed: {' '.join(command)}")
    return done.stdout


def cargo(command, binary, target=M4F, features="", **settings):
    own = "" if binary in ("steps", "minimal") else binary
    options = ["--target", target, "--target-dir", "target"]  # whatever the user's configuration
    options += ["--features", f"{own} {features}", "--bin", binary]
    return run("cargo", command, "--quiet", "--locked", "--release", *options, **settings)


@functools.cache
def printed(binary, **options):
    """The figures that a binary prints: {(arithmetic, figure): value}."""
    lines = re.findall(r"^(\w+) (\w+) (\d+)$", cargo("run", binary, **options), re.MULTILINE)
    return {(arithmetic, figure): int(value) for arithmetic, figure, value in lines}


def image(binary, target=M4F, **options):
    """The path of the firmware, once built."""
    cargo("build", binary, target=target, **options)
    return f"target/{target}/release/{binary}"


def flash(path):
    """Bytes of code, constants and initial values."""
    sections = run("readelf", "--sections", "--wide", path)  # of any architecture
    sizes = re.findall(r" \.(?:text|rodata|data) +PROGBITS +\w+ +\w+ +(\w+)", sections)
    return sum(int(size, 16) for size in sizes)


def minimal(arithmetics, **options):
    """For each arithmetic the path of the minimal firmware, which the next one overwrites, and the
    flash of the crate in it."""
    without = flash(image("minimal", minimal="without", **options))
    for arithmetic in arithmetics:
        path = image("minimal", minimal=arithmetic, **options)
        yield arithmetic, path, flash(path) - without


def measure_m4f():
    figures = printed("steps") | printed("bench") | printed("learn") | printed("policy")
    for arithmetic, path, size in minimal(ARITHMETICS):
        figures[arithmetic, "flash"] = size
        each = cycles.per_instruction(path)
        figures[arithmetic, "cycles"] = round(figures[arithmetic, "step"] * each)
    for arithmetic, step in steps(ARITHMETICS, rustflags=TUNED):
        each = cycles.per_instruction(image("minimal", minimal=arithmetic, rustflags=TUNED))
        figures[arithmetic, "tuned"] = tuned = round(step * each)
        figures[arithmetic, "rate"] = int(float(f"{64e6 / tuned:.3g}"))
    [(_, _, figures["fast", "physics"])] = minimal(["physics"])
    return figures


def of_cores(measure):
    """The figures of each core: {(arithmetic, core): value}. `measure` returns those of one build:
    [(arithmetic, value)]."""
    figures = {}
    for name, core in CORES.items():
        options = {"target": core.target, "rustflags": core.rustflags, "machine": core.machine}
        each = measure(ARITHMETICS, **options)
        if not core.has_fpu:
            soft = measure(["fast", "micro"], features="soft-floats", **options)
            each += [(f"{arithmetic}_soft_floats", value) for arithmetic, value in soft]
        figures |= {(arithmetic, name): value for arithmetic, value in each}
    return figures


def steps(arithmetics, figure="step", **options):
    figures = printed("steps", **options)
    return [(arithmetic, figures[arithmetic, figure]) for arithmetic in arithmetics]


def stacks(arithmetics, **options):
    return steps(arithmetics, "stack", **options)


def sizes(arithmetics, **options):
    return [(arithmetic, size) for arithmetic, _, size in minimal(arithmetics, **options)]


def firmware(name, column):
    # Its messages name source files by their paths, whose length would count.
    home = os.environ.get("CARGO_HOME", pathlib.Path.home() / ".cargo")
    rustflags = f"--remap-path-prefix={home}="
    return printed(name, rustflags=rustflags) | {
        (column, "flash_bytes"): flash(image(name, rustflags=rustflags))
    }


def measure_additions():
    def size(name):
        return flash(image("minimal", minimal=name, features="serde" if name == "serde" else ""))

    alone = size("fast")
    figures = printed("minimal", minimal="lqr_stack")
    others = [name for name in ADDITIONS if ("fast", name) not in figures]
    return figures | {("fast", name): size(name) - alone for name in others}


Table = collections.namedtuple("Table", "title columns rows measure")
TABLES = {
    "m4f": Table("on a Cortex-M4F", ARITHMETICS, ROWS, measure_m4f),
    "additions": Table(ADDED, {"fast": "bytes"}, ADDITIONS, measure_additions),
    "balance": Table("largest torque", LIMITS, BALANCE, lambda: firmware("balance", "10_Nm")),
    "control": Table(UPRIGHT, CONTROLLED, CONTROL, lambda: printed("bench")),
    "real": Table("a real acrobot", {"real": "6 N m"}, REAL, lambda: firmware("real", "real")),
    "cores": Table("instructions per step", CORE_COLUMNS, CORE_ROWS, lambda: of_cores(steps)),
    "stacks": Table("bytes of stack of a step", ARITHMETICS, CORE_ROWS, lambda: of_cores(stacks)),
    "sizes": Table("bytes of flash", CORE_COLUMNS, CORE_ROWS, lambda: of_cores(sizes)),
}


def written(table, figures):
    """The lines of a table."""
    texts = {key: f"{value:,}" for key, value in figures.items()}
    yield f"| {table.title} | {' | '.join(table.columns.values())} |"
    yield "|---|" + "---|" * len(table.columns)
    for row, words in table.rows.items():
        cells = [texts.get((column, row), "") for column in table.columns]
        yield f"| {' | '.join([words, *cells])} |"


def main():
    names = ", ".join(TABLES)
    parser = argparse.ArgumentParser(description="Compares what the crate costs with the page.")
    parser.add_argument("tables", nargs="*", metavar="TABLE", help=f"one of {names}; default: all")
    parser.add_argument("--update", action="store_true", help="write the tables into the page")
    options = parser.parse_args()
    if unknown := set(options.tables) - TABLES.keys():
        parser.error(f"there is no table {', '.join(sorted(unknown))}; there are: {names}")
    page = DOCUMENT.read_text().splitlines()
    lines = page.copy()
    for table in [TABLES[name] for name in options.tables or TABLES]:
        rows = list(written(table, table.measure()))
        print("\n".join(rows), flush=True)
        start = lines.index(rows[0])
        lines[start : lines.index("", start)] = rows
    if options.update:
        DOCUMENT.write_text("\n".join(lines) + "\n")
    elif lines != page:
        difference = difflib.unified_diff(page, lines, "the page", "measured", n=0, lineterm="")
        sys.exit("\n".join(difference) + "\nIf this is intended: python3 figures.py --update")


main()
