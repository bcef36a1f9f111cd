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
ARITHMETICS = ["fast", "micro", "reference", "portable"]
M7 = "-C target-cpu=cortex-m7 -C link-arg=--defsym=RAM_ORIGIN=0x60000000"
Core = collections.namedtuple("Core", "target has_fpu rustflags machine", defaults=[False, "", ""])
# These exclude the first table, which has more figures of the Cortex-M4F.
CORES = {
    "m0": Core("thumbv6m-none-eabi"),
    "m3": Core("thumbv7m-none-eabi"),
    "m7": Core(M4F, True, M7, "mps2-an500"),
    "m33": Core("thumbv8m.main-none-eabihf", True),
    "rv32i": Core("riscv32i-unknown-none-elf"),
    "rv32imc": Core("riscv32imc-unknown-none-elf"),
    "rv32imafc": Core("riscv32imafc-unknown-none-elf", True),
}
ADDITIONS = ["message", "display", "serde", "lqr", "lqr_stack"]


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


def measure_real():
    """Lets `rig` record, identify and control a machine that it plays, with firmware in QEMU."""
    home = os.environ.get("CARGO_HOME", pathlib.Path.home() / ".cargo")
    rustflags = f"--remap-path-prefix={home}="
    # In the root folder, because this one's configuration of Cargo is for firmware.
    build = "env --unset=CARGO_BUILD_TARGET --chdir=../.. cargo build --quiet --locked --release"
    run(*build.split(), "-p", "desktop", "--bin", "rig", "--target-dir", "target")
    rig = functools.partial(run, pathlib.Path("../../target/release/rig"), rustflags=rustflags)
    machines, recording, found = "../desktop", "target/recording.csv", "target/machine.toml"
    board = ["exec:./real", "--play", f"{machines}/realaigym.toml"]
    rig("record", f"{machines}/drawn.toml", *board, recording)
    rig("identify", f"{machines}/drawn.toml", recording, found)
    lines = re.findall(r"^real (\w+) (\d+)$", rig("run", found, *board), re.MULTILINE)
    figures = {("real", figure): int(value) for figure, value in lines}
    return figures | {("real", "flash_bytes"): flash(image("real", rustflags=rustflags))}


def measure_additions():
    def size(name):
        return flash(image("minimal", minimal=name, features="serde" if name == "serde" else ""))

    alone = size("fast")
    figures = printed("minimal", minimal="lqr_stack")
    others = [name for name in ADDITIONS if ("fast", name) not in figures]
    return figures | {("fast", name): size(name) - alone for name in others}


# The title is a table's first cell in the page, which has the words. Here columns and rows are the
# names of its figures, in order.
Table = collections.namedtuple("Table", "title columns rows measure")
M4F_ROWS = "step cycles tuned rate draw redraw flash physics size stack learn training"
M4F_ROWS += " decision decision_ram ram"
BALANCE = "plan_s plan_millions uncaught catch_mean_s catch_longest_s error_mrad"
BALANCE += " instructions_mean instructions_most flash_bytes ram_bytes"
CONTROL = "linearize linearize_step dlqr torque inverse_dynamics estimator"
CONTROL += " estimator_params"
REAL = "upright_ms again_ms tick_instructions slices slice_ticks flash_bytes ram_bytes"
LIMITS = ["10_Nm", "2_Nm", "1_Nm"]
ADDED, UPRIGHT = "what a firmware adds to an acrobot", "instructions at 100 Hz, upright"
ALL = [*ARITHMETICS, "fast_soft_floats", "micro_soft_floats"]
TABLES = {
    "m4f": Table("on a Cortex-M4F", ARITHMETICS, M4F_ROWS.split(), measure_m4f),
    "additions": Table(ADDED, ["fast"], ADDITIONS, measure_additions),
    "balance": Table(
        "largest torque", LIMITS, BALANCE.split(), lambda: firmware("balance", "10_Nm")
    ),
    "control": Table(UPRIGHT, ["fast", "reference"], CONTROL.split(), lambda: printed("bench")),
    "real": Table("a real acrobot", ["real"], REAL.split(), measure_real),
    "cores": Table("instructions per step", ALL, CORES, lambda: of_cores(steps)),
    "stacks": Table("bytes of stack of a step", ARITHMETICS, CORES, lambda: of_cores(stacks)),
    "sizes": Table("bytes of flash", ALL, CORES, lambda: of_cores(sizes)),
}


#: Cargo hashes the path of a dependency outside of its workspace, so on another checkout a
#: firmware's functions have another order, and other bytes of padding between them.
PADDING = 32


def is_padding(before, now):
    number = [int(cell.replace(",", "") or 0) for cell in (before, now)]
    return abs(number[0] - number[1]) <= PADDING


def write(table, figures, lines):
    """Replaces the figures of a table in the lines of the page."""
    texts = {key: f"{value:,}" for key, value in figures.items()}
    head = next(i for i, line in enumerate(lines) if line.startswith(f"| {table.title} |"))
    rows = range(head + 2, lines.index("", head))
    for i, row in zip(rows, table.rows, strict=True):
        cells = [texts.get((column, row), "") for column in table.columns]
        label, *before = lines[i].removesuffix(" |").split(" | ")
        if row != "flash_bytes" or not all(map(is_padding, before, cells)):
            lines[i] = " | ".join([label, *cells]) + " |"
    print("\n".join(lines[head : rows.stop]), flush=True)


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
        write(table, table.measure(), lines)
    if options.update:
        DOCUMENT.write_text("\n".join(lines) + "\n")
    elif lines != page:
        difference = difflib.unified_diff(page, lines, DOCUMENT.name, "measured", n=0, lineterm="")
        sys.exit("\n".join(difference) + "\nIf this is intended: python3 figures.py --update")


main()
