"""Compares the bits of each platform, or of those with the given names, with the recorded digests.
Then writes the table of all into `docs/determinism.md`.
"""

import os
import pathlib
import subprocess
import sys
from typing import NamedTuple

ROOT = pathlib.Path(__file__).resolve().parents[2]
DOCUMENT = ROOT / "docs/determinism.md"


class Platform(NamedTuple):
    name: str
    target: str
    flags: str = ""
    machine: str = ""  # of QEMU, if not the one in .cargo/config.toml
    features: str = ""
    equal: bool = True


M4F, M33 = "thumbv7em-none-eabihf", "thumbv8m.main-none-eabihf"
FAST_MATH = "-C link-arg=-Ofast"
RAM_OF_AN500 = "-C link-arg=--defsym=RAM_ORIGIN=0x60000000"
PLATFORMS = [
    Platform("x86-64", "x86_64-unknown-linux-gnu"),
    Platform("x86 with SSE2", "i686-unknown-linux-musl"),
    Platform("AArch64 with NEON", "aarch64-unknown-linux-musl"),
    Platform("s390x, big-endian", "s390x-unknown-linux-gnu"),
    Platform("Cortex-M0", "thumbv6m-none-eabi"),
    Platform("Cortex-M0, soft-floats", "thumbv6m-none-eabi", features="soft-floats"),
    Platform("Cortex-M3", "thumbv7m-none-eabi"),
    Platform("Cortex-M4 without FPU", "thumbv7em-none-eabi"),
    Platform("Cortex-M4F", M4F),
    Platform("Cortex-M7 with `f64`", M4F, f"-C target-cpu=cortex-m7 {RAM_OF_AN500}", "mps2-an500"),
    Platform("Cortex-M33", M33),
    Platform("RV32IMC", "riscv32imc-unknown-none-elf"),
    Platform("RV32IMC, soft-floats", "riscv32imc-unknown-none-elf", features="soft-floats"),
    Platform("RV32IMAFC", "riscv32imafc-unknown-none-elf"),
    Platform("RV64GC", "riscv64gc-unknown-none-elf"),
    Platform("WebAssembly", "wasm32-wasip1"),
    Platform("WebAssembly with SIMD", "wasm32-wasip1", "-C target-feature=+simd128"),
    # These show that a difference is found.
    Platform("Cortex-M4F, fused by LLVM", M4F, "-C llvm-args=-fp-contract=fast", equal=False),
    Platform("Cortex-M55 with Helium", M33, "-C target-cpu=cortex-m55", "mps3-an547", equal=False),
    Platform("x86-64, flushed by gcc", "x86_64-unknown-linux-gnu", FAST_MATH, equal=False),
]
HEAD = ["| platform | Rust target | options | bits |", "|---|---|---|---|"]


def row(platform):
    options = platform.flags or platform.features and f"--features {platform.features}"
    cells = [platform.name, f"`{platform.target}`", options and f"`{options}`"]
    cells.append("equal" if platform.equal else "differ")
    return f"| {' | '.join(cells)} |"


def wrong(platform):
    """Runs the program on a platform. Returns what is wrong."""
    print(f"\n=== {row(platform)}", flush=True)
    environment = os.environ | {"RUSTFLAGS": platform.flags}
    if platform.machine:
        name = platform.target.upper().replace("-", "_").replace(".", "_")
        environment[f"CARGO_TARGET_{name}_RUNNER"] = f"{ROOT}/.cargo/qemu arm {platform.machine}"
    options = ["--quiet", "--locked", "--release", "--package=bits", f"--target={platform.target}"]
    options.append(f"--features={platform.features}")
    build, run = (["cargo", each, *options] for each in ("build", "run"))
    if subprocess.run(build, cwd=ROOT, env=environment).returncode != 0:
        return "does not compile"
    try:
        # A stack overflow makes a microcontroller loop forever.
        settings = {"cwd": ROOT, "env": environment, "stdout": subprocess.PIPE, "text": True}
        done = subprocess.run(run, timeout=300, **settings)
    except subprocess.TimeoutExpired:
        return "takes more than 300 s"
    print(done.stdout, end="", flush=True)
    if done.stdout.count("\n") < 10 or done.returncode > 1:
        return "does not run to the end"
    equal = done.returncode == 0
    if equal != platform.equal:
        return "has equal bits, but should not" if equal else "has other bits"


def main():
    known = {each.name: each for each in PLATFORMS}
    chosen = [known[name] for name in sys.argv[1:] or known]
    if failures := [f"{each.name} {reason}" for each in chosen if (reason := wrong(each))]:
        sys.exit("\n" + "\n".join(failures))
    before, old = DOCUMENT.read_text().split(HEAD[0])
    _, after = old.split("\n\n", 1)
    table = "\n".join([*HEAD, *map(row, PLATFORMS)])
    DOCUMENT.write_text(f"{before}{table}\n\n{after}")


main()
