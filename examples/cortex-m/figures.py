"""Measures what the crate costs on microcontrollers, and compares it with the tables in `docs/embedded.md`.

    python3 figures.py             fails if a figure has grown by more than 5 %, and prints every figure
    python3 figures.py --update    writes the tables
    python3 figures.py cores       only the tables that are named: m4f, balance, control, cores, stacks, sizes, levels

`steps` counts instructions, stack and RAM, `bench`, `learn` and `balance` count instructions. Flash is that of `minimal_fast` and the others minus that of
`minimal_without`. `cycles.py` estimates the cycles per instruction.
"""

import argparse
import collections
import functools
import os
import pathlib
import re
import subprocess
import sys

import cycles

DOCUMENT = pathlib.Path("../../docs/embedded.md")
TOLERANCE = 1.05
M4F = "thumbv7em-none-eabihf"
TUNED = "-C target-cpu=cortex-m4"
M7 = "-C target-cpu=cortex-m7"
ARITHMETICS = {"fast": "`Fast`", "micro": "`Micro`", "reference": "`Reference`", "portable": "`Portable`"}
COLUMNS = {
    "fast": "`Fast`",
    "micro": "`Micro`",
    "reference": "`Reference`",
    "reference_libgcc": "`Reference`, libgcc",
    "portable": "`Portable`",
    "portable_libgcc": "`Portable`, libgcc",
    "micromath": "micromath's sine",
}
ROWS = {
    "step": "instructions per step, with observation, end test and resets",
    "cycles": "cycles per step, estimated",
    "tuned": f"cycles per step with `{TUNED}`, estimated",
    "sin_cos": "instructions per sine and cosine",
    "reset": "instructions per reset",
    "draw": "instructions per frame of 128×64 pixels",
    "redraw": "instructions per frame if only what moved is drawn",
    "flash": "flash of the crate with seeding, bytes",
    "physics": "flash of the pendulum alone, bytes",
    "size": "RAM of an `Acrobot`, bytes",
    "stack": "stack of a step, bytes",
    "learn": "instructions per step of training",
    "training": "training until the mean return of 100 episodes is −100, millions of instructions",
    "milliseconds": "time of this training at 168 MHz, estimated, ms",
    "ram": "RAM of the whole firmware that trains and draws, bytes",
}
SOFT_FLOATS = {"fast_soft_floats": "`Fast`, soft-floats", "micro_soft_floats": "`Micro`, soft-floats"}
Core = collections.namedtuple("Core", "words target has_fpu rustflags machine", defaults=[False, "", ""])
CORES = {
    "m0": Core("Cortex-M0", "thumbv6m-none-eabi"),
    "m3": Core("Cortex-M3", "thumbv7m-none-eabi"),
    "m4f": Core("Cortex-M4F", M4F, True),
    # This machine has its RAM at another address.
    "m7": Core("Cortex-M7 with `f64`", M4F, True, f"{M7} -C link-arg=--defsym=RAM_ORIGIN=0x60000000", "mps2-an500"),
    "m33": Core("Cortex-M33 with FPU", "thumbv8m.main-none-eabihf", True),
    "rv32i": Core("RV32I", "riscv32i-unknown-none-elf"),
    "rv32imc": Core("RV32IMC", "riscv32imc-unknown-none-elf"),
    "rv32imafc": Core("RV32IMAFC", "riscv32imafc-unknown-none-elf", True),
}
CORE_ROWS = {name: f"{core.words}, `{core.target}`" for name, core in CORES.items()}
LIMITS = {
    "10_Nm": "10 N m, 1,000 initial states",
    "7_Nm": "7 N m, 100",
    "5_Nm": "5 N m, 100",
    "2_Nm": "2 N m, 100",
    "1_Nm": "1 N m, 100",
}
BALANCE = {
    "missed": "not caught within 200 s",
    "catch_mean_s": "mean time to catch, s",
    "catch_longest_s": "longest time to catch, s",
    "error_mrad": "largest error of an angle while held, mrad",
    "instructions_mean": "instructions per decision, mean",
    "instructions_most": "instructions per decision, most",
    "flash_bytes": "flash of the whole firmware, bytes",
    "ram_bytes": "RAM of the whole firmware, bytes",
}
CONTROL = {
    "linearize": "`linearize`",
    "discretize": "`discretize`",
    "lqr": "`lqr`",
    "torque": "`difference` and `Lqr::torque`",
    "inverse_dynamics": "`inverse_dynamics`",
    "velocities": "`velocities`",
}
LEVELS = ["3", "2", '"s"', '"z"']
CLOCKS = {
    "STM32F4 (Cortex-M4F)": 168,
    "nRF52840 (Cortex-M4F)": 64,
    "RP2350 (Cortex-M33, assumed to have the same timings)": 150,
}


def run(*command, rustflags="", machine=""):
    environment = os.environ | {"RUSTFLAGS": rustflags}
    if machine:
        environment["CARGO_TARGET_THUMBV7EM_NONE_EABIHF_RUNNER"] = f"../../.cargo/qemu arm {machine}"
    done = subprocess.run(command, stdout=subprocess.PIPE, text=True, env=environment)
    if done.returncode != 0:
        sys.exit(f"{done.stdout}failed: {' '.join(command)}")
    return done.stdout


def cargo(command, *binaries, target=M4F, features="", level="3", **settings):
    options = ["--quiet", "--locked", "--release", "--target", target, "--features", features]
    options += ["--config", f"profile.release.opt-level={level}"]
    return run("cargo", command, *options, *(f"--bin={binary}" for binary in binaries), **settings)


@functools.cache
def printed(binary, **options):
    """The figures that a binary prints: {(arithmetic, figure): value}."""
    lines = re.findall(r"^(\w+) (\w+) (\d+)$", cargo("run", binary, **options), re.MULTILINE)
    return {(arithmetic, figure): int(value) for arithmetic, figure, value in lines}


def images(*binaries, target=M4F, **options):
    """The paths of the firmware, once built: {binary: path}."""
    cargo("build", *binaries, target=target, **options)
    return {binary: f"target/{target}/release/{binary}" for binary in binaries}


def flash(path):
    """Bytes of code, constants and initial values."""
    sections = run("readelf", "--sections", "--wide", path)  # of any architecture
    return sum(int(size, 16) for size in re.findall(r" \.(?:text|rodata|data) +PROGBITS +\w+ +\w+ +(\w+)", sections))


def minimal(arithmetics, **options):
    """The paths of the minimal firmware, and the flash of the crate in it: {arithmetic: path}, {arithmetic: bytes}."""
    built = images("minimal_without", *(f"minimal_{each}" for each in arithmetics), **options)
    without = flash(built["minimal_without"])
    paths = {each: built[f"minimal_{each}"] for each in arithmetics}
    return paths, {each: flash(path) - without for each, path in paths.items()}


def measure_m4f():
    figures = {}
    for suffix, features, arithmetics in [
        ("", "", [*ARITHMETICS, "micromath"]),
        ("_libgcc", "libgcc", ["reference", "portable"]),
    ]:
        counted = printed("steps", features=features) | printed("bench", features=features)
        figures |= {(arithmetic + suffix, figure): value for (arithmetic, figure), value in counted.items()}
        paths, sizes = minimal(arithmetics, features=features)
        for arithmetic, path in paths.items():
            column = arithmetic + suffix
            figures[column, "flash"] = sizes[arithmetic]
            figures[column, "cycles"] = round(figures[column, "step"] * cycles.per_instruction(path))
    counted = printed("steps", rustflags=TUNED)
    paths, _ = minimal([*ARITHMETICS, "micromath"], rustflags=TUNED)
    for arithmetic, path in paths.items():
        figures[arithmetic, "tuned"] = round(counted[arithmetic, "step"] * cycles.per_instruction(path))
    figures["fast", "physics"] = minimal(["physics"])[1]["physics"]
    figures |= printed("learn")
    # The first three episodes. Nothing is printed before the tenth.
    each = cycles.per_instruction(images("learn")["learn"], most=3_000_000)
    figures["fast", "milliseconds"] = round(figures["fast", "training"] * each / 168 * 1000)
    return figures


def measure_cores(figure):
    return {
        (arithmetic + suffix, name): value
        for name, core in CORES.items()
        for suffix, features in [("", "")] + [("_soft_floats", "soft-floats")] * (not core.has_fpu)
        for (arithmetic, each), value in printed("steps", features=features, **options(core)).items()
        if each == figure
    }


def measure_sizes():
    return {
        (arithmetic, name): size
        for name, core in CORES.items()
        for arithmetic, size in minimal(ARITHMETICS, **options(core))[1].items()
    }


def options(core):
    return {"target": core.target, "rustflags": core.rustflags, "machine": core.machine}


def measure_levels():
    figures = {}
    for level in LEVELS:
        counted = printed("steps", level=level)
        _, sizes = minimal(ARITHMETICS, level=level)
        for arithmetic in ARITHMETICS:
            figures[arithmetic, f"step {level}"] = counted[arithmetic, "step"]
            figures[arithmetic, f"flash {level}"] = sizes[arithmetic]
    return figures


def measure_balance():
    return printed("balance") | {("10_Nm", "flash_bytes"): flash(images("balance")["balance"])}


Table = collections.namedtuple("Table", "title columns rows measure")
TABLES = {
    "m4f": Table("on a Cortex-M4F", COLUMNS, ROWS, measure_m4f),
    "balance": Table("largest torque", LIMITS, BALANCE, measure_balance),
    "control": Table("instructions at 100 Hz, upright", ARITHMETICS, CONTROL, lambda: printed("bench")),
    "cores": Table("instructions per step", ARITHMETICS | SOFT_FLOATS, CORE_ROWS, lambda: measure_cores("step")),
    "stacks": Table("bytes of stack of a step", ARITHMETICS, CORE_ROWS, lambda: measure_cores("stack")),
    "sizes": Table("bytes of flash", ARITHMETICS, CORE_ROWS, measure_sizes),
    "levels": Table(
        "`opt-level` on a Cortex-M4F",
        ARITHMETICS,
        {f"step {level}": f"`{level}`, instructions per step" for level in LEVELS}
        | {f"flash {level}": f"`{level}`, bytes of flash" for level in LEVELS},
        measure_levels,
    ),
}


def head(title, columns):
    return [f"| {title} | {' | '.join(columns)} |", "|---|" + "---|" * len(columns)]


def written(table, figures):
    """The lines of a table."""
    cells = {key: f"{value:,}" for key, value in figures.items()}
    yield from head(table.title, table.columns.values())
    for row, words in table.rows.items():
        yield f"| {words} | " + " | ".join(cells.get((column, row), "") for column in table.columns) + " |"


def rates(figures):
    """The lines of the table of steps per second, to three digits, from the table of the Cortex-M4F."""
    yield from head("steps per second, on paper", ["clock", *ARITHMETICS.values()])
    for part, megahertz in CLOCKS.items():
        each = [megahertz * 1e6 / figures[arithmetic, "tuned"] for arithmetic in ARITHMETICS]
        cells = [f"{float(f'{rate:.3g}'):,.0f}" for rate in each]
        yield f"| {part} | {megahertz} MHz | {' | '.join(cells)} |"


def find(first, lines):
    """Where the table begins that has this first line, and where it ends."""
    start = lines.index(first)
    return start, next((i for i in range(start, len(lines)) if not lines[i].startswith("|")), len(lines))


def documented(table, lines):
    """The figures of a table: {(column, row): value}."""
    names = {words: row for row, words in table.rows.items()}
    start, end = find(next(written(table, {})), lines)
    for line in lines[start + 2 : end]:
        words, *cells = [cell.strip() for cell in line.strip("|").split("|")]
        for column, cell in zip(table.columns, cells):
            if cell and words in names:
                yield (column, names[words]), int(cell.replace(",", ""))


def compare(name, old, figures):
    """Prints the figures, and returns what is wrong with them."""
    for key, value in figures.items():
        words = " ".join((name, *key))
        print(words, value)
        if key not in old:
            yield f"{words} is {value}; the table has no such figure"
        elif value > old[key] * TOLERANCE:
            yield f"{words} was {old[key]} and is {value}"
    for key in old.keys() - figures.keys():
        yield f"{' '.join((name, *key))} was {old[key]} and is not measured"


def main():
    parser = argparse.ArgumentParser(description="Measures what the crate costs on microcontrollers.")
    parser.add_argument("tables", nargs="*", metavar="TABLE", help=f"one of {', '.join(TABLES)}; default: all")
    parser.add_argument("--update", action="store_true", help="write the tables instead of comparing them")
    options = parser.parse_args()
    if unknown := set(options.tables) - TABLES.keys():
        parser.error(f"there is no table {', '.join(sorted(unknown))}; there are: {', '.join(TABLES)}")
    lines = DOCUMENT.read_text().splitlines()
    wrong = []
    for name in options.tables or TABLES:
        table = TABLES[name]
        figures = {key: value for key, value in table.measure().items() if key[0] in table.columns and key[1] in table.rows}
        new = [written(table, figures)] + ([rates(figures)] if name == "m4f" else [])
        if options.update:
            for rows in map(list, new):
                start, end = find(rows[0], lines)
                lines[start:end] = rows
            continue
        old = dict(documented(table, lines))
        wrong += compare(name, old, figures)
        if name == "m4f":
            rows = list(rates(old))
            start, end = find(rows[0], lines)
            if lines[start:end] != rows:
                wrong.append("the table of steps per second does not match the cycles")
    if options.update:
        DOCUMENT.write_text("\n".join(lines) + "\n")
    elif wrong:
        sys.exit("\n".join(wrong) + "\nIf this is intended: python3 figures.py --update")


main()
