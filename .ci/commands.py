#!/usr/bin/env python3
"""Fails where the docs have a command that CI did not run: python3 .ci/commands.py TRACE

TRACE is what bash traced of .ci/run: a folder, a tab and a command a line. A command on a line of its own has to have been
run in the folder of its crate, one within a sentence anywhere. What CI leaves out stands in .ci/commands.txt, with its reason.
"""

import re
import shlex
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
LEFT_OUT = ROOT / ".ci/commands.txt"
PROGRAMS = {"bash", "cargo", "node", "npm", "pip", "python", "python3", "./logger", "./minimise", "./run"}
# Neither a word that is to be replaced, nor what CI installs where it is missing.
ASIDE = re.compile(r"…|\b[A-Z]{4,}\b|^cargo install ")
# Words that say nothing of what is done.
QUIET = {"--locked", "--quiet", "--silent", "xvfb-run"}


def words(command):
    return tuple(word for word in shlex.split(command) if word not in QUIET)


def parts(line):
    """The commands of a line, without what is set for them, where each word is meant as it stands."""
    for command in re.split(r" (?:&&|\|) ", line):
        command = re.sub(r"^(sudo |\w+=\S* )+", "", command.strip())
        program = command.split(" ")[0]
        if program in PROGRAMS and (program.startswith("./") or " " in command) and not ASIDE.search(command):
            yield words(command)


def documented():
    """Each command, the folder that it is for if it stands on a line of its own, and the file that has it."""
    for name in subprocess.check_output(["git", "ls-files"], cwd=ROOT, text=True).splitlines():
        path = ROOT / name
        if path.suffix not in {".md", ".mjs", ".py", ".rs"} or path.name in {"CHANGELOG.md", Path(__file__).name}:
            continue
        text = path.read_text()
        if path.suffix == ".py":
            text = "\n".join(re.findall(r'"""(.*?)"""', text, re.S))
        elif path.suffix != ".md":
            text = "\n".join(re.findall(r"^ *//[/!]? ?(.*)", text, re.M))
        folder = next(folder for folder in path.parents if (folder / "Cargo.toml").exists()).relative_to(ROOT)
        blocks = re.findall(r"^```.*?^```", text, re.M | re.S) + re.findall(r"^    .*", text, re.M)
        for line in "\n".join(blocks).splitlines():
            for command in parts(re.split(r" {2,}| # ", line.strip())[0]):
                yield command, folder, name
        for span in re.findall(r"`([^`]+)`", re.sub(r"^```.*?^```", "", text, flags=re.M | re.S)):
            for command in parts(" ".join(span.split())):
                yield command, None, name


def main():
    run = set()
    for line in Path(sys.argv[1]).read_text().splitlines():
        folder, tab, command = line.lstrip("+").partition("\t")
        try:
            run |= {(words(command), where) for where in (Path(folder.removesuffix("/target/scratch")).relative_to(ROOT), None) if tab}
        except ValueError:  # the first of several lines
            pass
    left_out = {words(line) for line in LEFT_OUT.read_text().splitlines() if line and not line.startswith("#")}
    missing = {each for each in documented() if each[:2] not in run and each[0] not in left_out}
    stale = left_out - {command for command, folder, _ in documented() if (command, folder) not in run}
    for command, folder, name in sorted(missing, key=str):
        print(f"{name}: CI does not run {shlex.join(command)}{'' if folder is None else f' in {folder}'}")
    for command in sorted(stale):
        print(f".ci/commands.txt: no doc has {shlex.join(command)}, or CI runs it")
    sys.exit(bool(missing or stale))


main()
