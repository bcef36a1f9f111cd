"""Measures what the crate costs on a Cortex-M4F, and compares it with the table in the crate's README.

    python3 figures.py             fails if a figure has grown by more than 5 %, and prints the old and the new one
    python3 figures.py --update    writes the table and the one derived from it

`bench` and `learn` count instructions, stack and RAM. Flash is that of `minimal_fast` and the others minus that of
`minimal_without`. `cycles.py` estimates the cycles of an instruction.
"""

import os
import pathlib
import re
import subprocess
import sys

import cycles

README = pathlib.Path("../../README.md")
TOLERANCE = 1.05
COLUMNS = {
    "fast": "`Fast`",
    "micro": "`Micro`",
    "reference": "`Reference`",
    "reference_libgcc": "`Reference`, libgcc",
    "portable": "`Portable`",
    "portable_libgcc": "`Portable`, libgcc",
    "micromath": "by `micromath`",
}
ROWS = {
    "step": "instructions a step, with observation, end test and resets",
    "cycles": "cycles a step, estimated",
    "tuned": "the same with `-C target-cpu=cortex-m4`",
    "sin_cos": "instructions a sine and cosine",
    "reset": "instructions a reset",
    "draw": "instructions a frame of 128×64 pixels",
    "redraw": "instructions a frame of which only what moved is drawn",
    "flash": "flash of the crate, bytes, seeding included",
    "physics": "flash of the pendulum alone, bytes",
    "size": "RAM of an `Acrobot`, bytes",
    "stack": "stack of a step, bytes",
    "learn": "instructions a step with learning",
    "training": "millions of instructions until the mean of 100 episodes is −100",
    "milliseconds": "milliseconds that these take at 168 MHz, estimated",
    "ram": "RAM in all of the firmware that learns and draws, bytes",
}
CLOCKS = {
    "STM32F4 (Cortex-M4F)": 168,
    "nRF52840 (Cortex-M4F)": 64,
    "RP2350 (Cortex-M33, taken to have the same timings)": 150,
}
PAPER_HEAD = "| steps a second, on paper | clock | `Fast` | `Micro` | `Reference` | `Portable` |"
HEAD = "| on a Cortex-M4F | " + " | ".join(COLUMNS.values()) + " |"


def run(*command, rustflags=""):
    environment = os.environ | {"RUSTFLAGS": rustflags}
    return subprocess.run(command, check=True, stdout=subprocess.PIPE, text=True, env=environment).stdout


def bench(features="", rustflags="", binary="bench"):
    """The figures that it prints: arithmetic, figure and value."""
    options = ["--quiet", "--locked", "--release", "--features", features, "--bin", binary]
    lines = run("cargo", "run", *options, rustflags=rustflags)
    for arithmetic, figure, value in re.findall(r"^(\w+) (\w+) (\d+)$", lines, re.MULTILINE):
        yield arithmetic, figure, int(value)


def image(binary, features="", rustflags=""):
    """The path of that firmware."""
    options = ["--quiet", "--locked", "--release", "--features", features, "--bin", binary]
    run("cargo", "build", *options, rustflags=rustflags)
    return f"target/thumbv7em-none-eabihf/release/{binary}"


def flash(name, features=""):
    """Bytes of code, constants and initial values."""
    sections = run("size", "-A", image(f"minimal_{name}", features))
    return sum(int(size) for size in re.findall(r"^\.(?:text|rodata|data)\s+(\d+)", sections, re.MULTILINE))


def measure():
    figures = {(arithmetic, figure): value for arithmetic, figure, value in bench()}
    figures |= {(f"{arithmetic}_libgcc", figure): value for arithmetic, figure, value in bench("libgcc")}
    without = flash("without")
    figures["fast", "physics"] = flash("physics") - without
    tuned = "-C target-cpu=cortex-m4"
    for column in ["fast", "micro", "reference", "reference_libgcc", "portable", "portable_libgcc"]:
        arithmetic, _, features = column.partition("_")
        figures[column, "flash"] = flash(arithmetic, features) - without
        each = cycles.per_instruction(image(f"minimal_{arithmetic}", features))
        figures[column, "cycles"] = round(figures[column, "step"] * each)
    for arithmetic, figure, value in bench(rustflags=tuned):
        if figure == "step" and arithmetic != "micromath":
            figures[arithmetic, "tuned"] = round(value * cycles.per_instruction(image(f"minimal_{arithmetic}", rustflags=tuned)))
    figures |= {(arithmetic, figure): value for arithmetic, figure, value in bench(binary="learn")}
    # A hundred steps. From step 58 on there are as many traces as there will be.
    each = cycles.per_instruction(image("learn"), most=3_000_000)
    figures["fast", "milliseconds"] = round(figures["fast", "training"] * each / 168 * 1000)
    return {key: value for key, value in figures.items() if key[0] in COLUMNS and key[1] in ROWS}


def table(figures):
    def cell(column, row):
        return f"{figures[column, row]:,}" if (column, row) in figures else ""

    yield HEAD
    yield "|---|" + "---|" * len(COLUMNS)
    for row, words in ROWS.items():
        yield f"| {words} | " + " | ".join(cell(column, row) for column in COLUMNS) + " |"


def paper(figures):
    """Steps a second on some parts, from the cycles, to three digits."""
    yield PAPER_HEAD
    yield "|---|---|---|---|---|---|"
    for part, megahertz in CLOCKS.items():
        rates = [megahertz * 1e6 / figures[arithmetic, "tuned"] for arithmetic in ("fast", "micro", "reference", "portable")]
        cells = [f"{int(float(f'{rate:.3g}')):,}" for rate in rates]
        yield f"| {part} | {megahertz} MHz | {' | '.join(cells)} |"


def find(head, lines):
    """The first line of the table with that head, and the one after its last."""
    start = lines.index(head)
    return start, next(i for i in range(start, len(lines)) if not lines[i].startswith("|"))


def documented(lines):
    """The figures in the README's table."""
    names = {words: row for row, words in ROWS.items()}
    start, end = find(HEAD, lines)
    for line in lines[start + 2 : end]:
        words, *cells = [cell.strip() for cell in line.strip("|").split("|")]
        for column, cell in zip(COLUMNS, cells):
            if cell and words in names:
                yield (column, names[words]), int(cell.replace(",", ""))


def main():
    figures = measure()
    lines = README.read_text().splitlines()
    if sys.argv[1:] == ["--update"]:
        for head, rows in [(HEAD, table), (PAPER_HEAD, paper)]:
            start, end = find(head, lines)
            lines[start:end] = rows(figures)
        README.write_text("\n".join(lines) + "\n")
        return
    old = dict(documented(lines))
    grown = []
    for key, value in figures.items():
        print(*key, value)
        if key not in old:
            grown.append(f"{' '.join(key)} is {value}; the README has no such figure")
        elif value > old[key] * TOLERANCE:
            grown.append(f"{' '.join(key)} was {old[key]} and is {value}")
    start, end = find(PAPER_HEAD, lines)
    if lines[start:end] != list(paper(old)):
        grown.append("the table of steps a second does not match the cycles")
    for key in old.keys() - figures.keys():
        grown.append(f"{' '.join(key)} was {old[key]} and is not measured")
    if grown:
        sys.exit("\n".join(grown) + "\nIf this is intended: python3 figures.py --update")


main()
