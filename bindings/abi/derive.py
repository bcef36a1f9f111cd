"""Writes what bindings and pages repeat of the crate: python3 bindings/abi/derive.py

The sources are comments of the crate, from which C's structs follow, and the header that cbindgen
0.29.4 writes of these. With --check nothing is written, and a file that would change is an error.
"""

import json
import math
import re
import subprocess
import sys
import textwrap
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
ABI, NPM = "bindings/abi/src/", "bindings/npm/package/"
PYTHON = "bindings/python/python/acrobot_rs/"
#: Gymnasium's names of parameters. Others are in capitals, with `_` before the joint's number.
GYMNASIUM = {
    **{"length1": "LINK_LENGTH_1", "length2": "LINK_LENGTH_2"},
    **{"mass1": "LINK_MASS_1", "mass2": "LINK_MASS_2"},
    **{"center_of_mass1": "LINK_COM_POS_1", "center_of_mass2": "LINK_COM_POS_2"},
    **{"inertia1": "LINK_MOI_1", "inertia2": "LINK_MOI_2"},
    **{"gravity": "gravity", "dt": "dt", "torques": "AVAIL_TORQUE"},
    **{"max_velocity1": "MAX_VEL_1", "max_velocity2": "MAX_VEL_2"},
    **{"torque_noise": "torque_noise_max", "dynamics": "book_or_nips"},
}
#: Bytes in wasm32, which are also the alignment.
BYTES = {
    **{"bool": 1, "char": 1, "uint8_t": 1, "double": 8},
    **dict.fromkeys(["float", "int", "int32_t", "uint32_t", "size_t", "pointer"], 4),
}
PI = "core::f64::consts::PI"
old = []


def read(path):
    return (ROOT / path).read_text()


def write(path, text):
    if not (ROOT / path).exists() or read(path) != text:
        old.append(path)
        if "--check" not in sys.argv:
            (ROOT / path).write_text(text)


def fill(path, start, lines, end):
    """Writes the lines between two lines of a file."""
    before, found, rest = read(path).partition(f"\n{start}\n")
    _, closed, after = f"\n{rest}".partition(f"\n{end}\n")
    assert found and closed, f"{path} must have the line {start!r}, and {end!r} after it"
    write(path, "\n".join([before, start, *lines, end, after]))


def declared(path, start):
    """Of each field or variant the name, the type, and two paragraphs of its comment."""
    body = read(path).partition(f"{start} {{\n")[2].partition("\n}")[0]
    found, comment = [], ""
    for line in map(str.strip, body.splitlines()):
        if line.startswith("///"):
            comment += f"{line[3:]}\n"
        elif field := re.fullmatch(r"(?:pub )?(\w+)(?:: (.+))?,", line):
            text, more = (" ".join(part.split()) for part in f"{comment}\n\n".split("\n\n")[:2])
            found.append((field[1], field[2], text, more))
            comment = ""
    assert found, f"{path} must have {start!r}"
    return found


def wrapped(text, mark, indent=""):
    """Lines of at most 100 columns. They do not break units and short lists of numbers."""
    text = re.sub(r"\b(N|kg|m) (?=m\b|m²|s/rad)", "\\1\xa0", text)
    text = re.sub(r"(\d,) (?=\d)", "\\1\xa0", text)
    lines = textwrap.wrap(text, 100, initial_indent=mark, subsequent_indent=mark + indent)
    return [line.replace("\xa0", " ") for line in lines]


def in_javascript(name):
    return re.sub(r"_(\w)", lambda letter: letter[1].upper(), name)


def in_python(name):
    return GYMNASIUM.get(name) or re.sub(r"(\d)$", r"_\1", name.upper())


def renamed(text, name, quote="`"):
    return re.sub(r"`(\w+)`", lambda code: quote + name(code[1]) + quote, text)


params = declared("src/physics/params.rs", "pub struct Params<S = f64>")
params.sort(key=lambda field: field[0] == "dynamics")  # last, as in C
costs = declared("src/control/plan/cost.rs", "pub struct Cost<S = f64>")
stds = declared("src/control/estimate/parameter_std.rs", "pub struct ParameterStd<S = f64>")
instruments = declared("src/task/instruments.rs", "pub struct Instruments<D = Option<Draw<f32>>>")
values = read("src/physics/params.rs").partition("const ACROBOT: Self = Self {")[2]
values = re.findall(r"(\w+): (\[.*?\]|[^,]+),", values.partition("};")[0])
values = {name: value.removesuffix(" as S").strip("()") for name, value in values}
files = "".join(path.read_text() for path in sorted((ROOT / "src/task").glob("*.rs")))
tasks = {}
for variant, _, text, _ in declared("src/task/any.rs", "pub enum AnyTask"):
    name = re.search(rf'Task for {variant} {{\s+const NAME: .* = "(\w+)"', files)[1]
    tasks[name] = text.partition("]. ")[2]


def with_defaults(dynamics):
    for name, kind, text, more in params:
        value = values[name].replace("Dynamics::Book", dynamics).replace(f" * {PI}", " π")
        value = re.sub(r"\.0\b", "", value).replace("-", "−")
        yield name, kind, f"{text} Default {value}.", more


# C's structs and constants, in Rust.
def struct(file, name, fields, number="f32"):
    lines = []
    for field, kind, text, _ in fields:
        kind = re.sub(r"\bS\b", number, kind).replace("Dynamics", "c_int")
        lines += [*wrapped(text, "    /// "), f"    pub {field}: {kind},"]
    fill(f"{ABI}{file}.rs", f"pub struct {name} {{", lines, "}")


struct("data", "acrobot_params_t", with_defaults("ACROBOT_DYNAMICS_BOOK"))
draws = [(name, kind, "", "") for name, kind, *_ in params[:-1]]
struct("data", "acrobot_draws_t", draws, "acrobot_draw_t")
struct("plan", "acrobot_cost_t", costs)
struct("estimate", "acrobot_parameter_std_t", stds)
settings = [(name, "S", *texts) for name, _, *texts in instruments]
struct("instruments", "acrobot_instruments_t", settings)
draws = [(name, "S", "", "") for name, *_ in instruments]
struct("instruments", "acrobot_instrument_draws_t", draws, "acrobot_draw_t")
lines = [""]
for number, (name, text) in enumerate(tasks.items()):
    lines += wrapped(text, "/// ")
    lines += [f"pub const ACROBOT_TASK_{name.upper()}: c_int = {number};", ""]
fill(f"{ABI}task.rs", "// derive.py writes the tasks.", lines, "// The end of the tasks.")

# C's header.
cbindgen = subprocess.run(["cbindgen", "--quiet"], cwd=ROOT / ABI / "..", stdout=-1, check=True)
header = cbindgen.stdout.decode()
for line in re.findall(r"^\w.{98,}\);$", header, re.MULTILINE):
    header = header.replace(line, "\n".join(wrapped(re.sub("(?<!,) ", "\xa0", line), "", "    ")))
write("bindings/c/include/acrobot.h", header)

# The layout of C's structs in wasm32, and assertions for the compiler that it is this.
sizes, structs = {kind: (size, size) for kind, size in BYTES.items()}, {}
for body, name in re.findall(r"typedef struct {(.*?)\n} (\w+);", header, re.DOTALL):
    end, most, structs[name] = 0, 1, {}
    for kind, star, field, counts in re.findall(r"\n  (?:const )?(\w+) (\*?)(\w+)(.*);", body):
        size, align = sizes["pointer" if star else kind]
        size *= math.prod(map(int, re.findall(r"\d+", counts)))
        start = end + -end % align
        end, most = start + size, max(most, align)
        structs[name][field] = start, size
    sizes[name] = end + -end % most, most
files = [(path.stem, path.read_text()) for path in sorted((ROOT / ABI).glob("*.rs"))]
homes = [home for home, text in files if any(f"struct {name} {{" in text for name in structs)]
lines = ["//! The layout that derive.py computes for JavaScript.", "", "use core::mem::offset_of;"]
lines += ["", *(f"use crate::{home}::*;" for home in homes)]
lines += ["", "/// The offset of the last field, which those before it decide, and the size."]
lines += ["const fn has<T>(last: usize, expected: usize, size: usize) {"]
lines += ["    assert!(last == expected && size_of::<T>() == size);", "}", "", "const _: () = {"]
for name, fields in structs.items():
    last, (start, _) = [*fields.items()][-1]
    parts = f"offset_of!({name}, {last})", start, sizes[name][0]
    line = f"    has::<{name}>({', '.join(map(str, parts))});"
    if len(line) > 100:
        line = "\n".join([f"    has::<{name}>(", *(f"        {x}," for x in parts), "    );"])
    lines += [line]
write(f"{ABI}layout.rs", "\n".join([*lines, "};", ""]))


# npm.
def entries(start, items, indent, end):
    listed = ", ".join(f"{in_javascript(name)}:\xa0{value}" for name, value in items)
    return [f"{start} {{", *wrapped(f"{listed},", indent), end]


lines = ["// derive.py writes this file: what acrobot.h says, with the layout in wasm32.", ""]
lines += [f"export const TASKS = {json.dumps([*tasks])};"]
for name, kind in {"STATUS": "status", "KINDS": "error_kind"}.items():
    body = re.search(rf"enum {{([^}}]*)}} acrobot_{kind}_t;", header)[1].lower()
    numbers = re.findall(r"acrobot_(?:error_)?(\w+) = (\d+)", body)
    lines += entries(f"export const {name} =", numbers, "  ", "};")
# The first definition is that of wasm32.
holders = dict(reversed(re.findall(r"#define ACROBOT(\w*)_SIZE (\d+)", header)))
holders = [(name.lower().strip("_") or "acrobot", size) for name, size in holders.items()]
lines += ["", "/** Bytes. */", *entries("export const SIZES =", sorted(holders), "  ", "};")]
lines += ["", "/** First word of 32 bits, and words. Two bools in one are `flags`. */"]
lines += ["export const STRUCTS = {"]
scripts = "".join(path.read_text() for path in (ROOT / NPM).glob("*.js") if path.stem != "layout")
for name, fields in structs.items():
    if name not in scripts:
        continue
    places = {}
    for field, (start, size) in fields.items():
        place = [start // 4, -(-size // 4)]
        if place in places.values():
            places.popitem()
            field = "flags"
        places[field] = place
    lines += entries(f"  {name}:", places.items(), "    ", "  },")
write(f"{NPM}layout.js", "\n".join([*lines, "};", ""]))


def interface(file, name, fields):
    kinds = {"S": "number", "Dynamics": '"book" | "nips"', "[[S; 4]; 4]": "Matrix"}
    kinds |= {"[S; 2]": "readonly [number, number]", "[S; 3]": "readonly [number, number, number]"}
    lines = []
    for field, kind, text, _ in fields:
        text = renamed(text, in_javascript)
        is_short = len(text) <= 100 - len("  /**  */")
        lines += [f"  /** {text} */"] if is_short else ["  /**", *wrapped(text, "   * "), "   */"]
        lines += [f"  {in_javascript(field)}: {kinds[kind]};"]
    fill(f"{NPM}{file}", f"export interface {name} {{", lines, "}")


interface("index.d.ts", "Params", with_defaults('"book"'))
interface("instruments.d.ts", "Instruments", settings)
interface("control.d.ts", "Cost", costs)
interface("control.d.ts", "ParameterStd", stds)
lines = ["/**", " * A task, by its name:", " *"]
for name, text in tasks.items():
    lines += wrapped(f'- "{name}": {text}', " * ", "  ")
lines += [" */", f"export type Task = {' | '.join(map(json.dumps, tasks))};"]
fill(f"{NPM}index.d.ts", "// derive.py writes the tasks.", lines, "// The end of the tasks.")

# Python.
lines, names = [], []
for field, kind, text, _ in params:
    name, text = in_python(field), renamed(text, in_python, "``")
    value = values[field].replace("Dynamics::Book", '"book"').replace(f".0 * {PI}", " * math.pi")
    value = value.replace("[", "(").replace("]", ")")
    if name == "LINK_MOI_1":
        lines += [f"    LINK_MOI: Any = {value}  #: of both links, kg m²; 0 or more"]
    if name.startswith("LINK_MOI"):
        text, value = f"{text} ``None``: ``LINK_MOI``.", None
    lines += [*wrapped(text, "    #: "), f"    {name}: Any = {value}"]
    names += {"S": [name], "[S; 3]": [name] * 3}.get(kind, [])
start, end = "    # derive.py writes the parameters.", "    # The end of the parameters."
fill(f"{PYTHON}parameters.py", start, lines, end)
lines = []
for field, _, text, _ in instruments:
    name = re.sub(r"(\d)$", r"_\1", field)
    lines += [*wrapped(text, "    #: "), f"    {name}: Any = None"]
start, end = "    # derive.py writes the instruments.", "    # The end of the instruments."
fill(f"{PYTHON}parameters.py", start, lines, end)
lines = [f"const NAMES: [&str; {len(names)}] = [", *(f'    "{name}",' for name in names)]
fill("bindings/python/src/lib.rs", "// derive.py writes the names.", lines, "];")
names = [f'    "{in_python(field)}",' for field, *_ in stds]
fill(f"{PYTHON}control/estimate.py", "_ESTIMATED = (", names, ")")


# Pages.
def table(path, what, head, rows):
    rows = [[cell.replace("|", r"\|") for cell in row] for row in [head, *rows]]
    lines = [f"| {' | '.join(row)} |" for row in rows]
    lines = ["", lines[0], "|" + "---|" * len(head), *lines[1:], ""]
    start, end = f"<!-- derive.py writes the {what}. -->", f"<!-- The end of the {what}. -->"
    fill(path, start, lines, end)


rows = []
for name, _, text, _ in with_defaults("`Book`"):
    rows += [(f"`{name}`", f"`{in_javascript(name)}`", f"`{in_python(name)}`", text)]
table("docs/numbers.md", "parameters", ["Rust, C", "JavaScript", "Python", "what"], rows)
rows = [(f"`{name}`", text, more.removeprefix("Raised: ")) for name, _, text, more in costs]
table("docs/control.md", "weights", ["field", "weight", "raised"], rows)
rows = [(f"`{name}`", f"`ACROBOT_TASK_{name.upper()}`", text) for name, text in tasks.items()]
table("docs/tasks.md", "tasks", ["name", "C", "what"], rows)

if old:
    print("\n".join(old))
    if "--check" in sys.argv:
        sys.exit("these files are old: run python3 bindings/abi/derive.py")
