"""Estimates the mean cycles per instruction on a Cortex-M4F, for `figures.py`.

The mean is over every instruction that QEMU executes in the loop of the firmware `minimal`. The
timing of each is that of ARM's Technical Reference Manual (ARM DDI 0439, 3.3.1 and 7.2.3). The
estimate assumes memory without wait states, and two cycles to refill the pipeline after a taken
branch.
"""

import functools
import re
import subprocess

STEPS = 50
COSTS = {"vdiv": 14, "vmla": 3, "vmls": 3, "udiv": 7, "sdiv": 7}
REGISTERS = re.compile(r"[rsd](\d+)(?:-[rsd](\d+))?|lr|pc|ip|fp|sl|sb")


def registers(operands):
    """The number of registers in a list such as {r4-r6, lr}."""
    names = REGISTERS.finditer(operands[operands.index("{") :])
    return sum(int(m[2]) - int(m[1]) + 1 if m[2] else 1 for m in names)


@functools.cache
def is_load(mnemonic):
    return re.match(r"v?(ldr|str)", mnemonic) is not None


@functools.cache
def cost(mnemonic, operands, taken, after_load):
    stem = mnemonic.split(".")[0]
    branch = 2 if taken else 0
    if stem[:4] in COSTS:
        return COSTS[stem[:4]]
    if stem in ("push", "pop", "vpush", "vpop") or re.match(r"v?(ldm|stm)", stem):
        return 1 + registers(operands) + branch
    if re.match(r"ldrd|strd", stem):
        return 3
    if is_load(stem):
        # A load or store right after another is pipelined.
        return (1 if after_load else 2) + branch
    return 1 + branch


def per_instruction(image):
    """The mean cycles per instruction of `STEPS` steps of the firmware `image`."""
    command = ["arm-none-eabi-objdump", "-d", "--no-show-raw-insn", image]
    listing = subprocess.check_output(command, text=True)
    code = {}
    for line in listing.splitlines():
        match = re.match(r"\s*([0-9a-f]+):\s+(\S+)\s*(.*)", line)
        if match:
            code[int(match[1], 16)] = (match[2], match[3])

    command = "qemu-system-arm -machine mps2-an386 -nographic -singlestep -d exec,nochain"
    command = [*command.split(), "-D", "/dev/stdout", "-kernel", image]
    qemu = subprocess.Popen(command, stdout=subprocess.PIPE, text=True)
    cycles = instructions = steps = 0
    previous, after_load = None, False
    for line in qemu.stdout:
        # A line is: Trace 0: 0x7f0000000000 [00800400/0000014c/00000110/ff020201]. The second
        # number is the address.
        _, *fields = line.split("/", 2)
        if len(fields) < 2:
            continue
        address = int(fields[0], 16)
        # Each step of the loop begins with a `nop`. Seeding comes before the first.
        if code[address][0] == "nop":
            steps += 1
            if steps > STEPS:
                break
        if steps > 0 and previous is not None:
            mnemonic, operands = code[previous]
            taken = address not in (previous + 2, previous + 4)
            instructions += 1
            cycles += cost(mnemonic, operands, taken, after_load)
            after_load = is_load(mnemonic)
        previous = address
    qemu.kill()
    return cycles / instructions
