"""The Python code of the documentation runs, and prints what its comments say."""

import json
import re
from pathlib import Path

import matplotlib.pyplot as plt
import pytest

ROOT = Path(__file__).resolve().parents[3]


PYTHON = "control", "firmware", "many", "parameters"
NAMES = "python", *(f"python-{name}" for name in PYTHON), "swingup", "gradients"
PAGES = ["README.md", "bindings/python/README.md", *(f"docs/{name}.md" for name in NAMES)]


def run(name, kind, capsys):
    """Runs all blocks of a page in one session, as a reader does."""
    page = ROOT / name
    blocks = re.findall(rf"^```{kind}\n(.*?)^```", page.read_text(), re.MULTILINE | re.DOTALL)
    assert blocks
    session = {}
    for block in blocks:
        exec(compile(block, page, "exec"), session)
        assert capsys.readouterr().out.splitlines() == re.findall(
            r"^# prints (.*)", block, re.MULTILINE
        )


@pytest.mark.parametrize("name", PAGES)
def test_code_runs_and_prints_what_its_comments_say(name, capsys, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    run(name, "python", capsys)
    if name == "docs/python-firmware.md":  # what the firmwares embed
        for committed in ("examples/cortex-m/src/plan.rs", "bindings/c/firmware/plan.h"):
            written = (tmp_path / Path(committed).name).read_bytes()
            assert written == (ROOT / committed).read_bytes(), committed


def test_the_course_prints_and_draws_what_is_committed(capsys, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    course = ROOT / "docs/course.ipynb"
    text = course.read_text()
    assert len(text) < 600_000
    for link in re.findall(r"\]\(([\w-]+\.md)", text):
        assert (course.parent / link).exists(), link
    cells = [cell for cell in json.loads(text)["cells"] if cell["cell_type"] == "code"]
    assert cells
    session = {}
    for cell in cells:
        plt.close("all")
        exec(compile("".join(cell["source"]), course, "exec"), session)
        printed = ["".join(output.get("text", [])) for output in cell["outputs"]]
        assert capsys.readouterr().out == "".join(printed)
        pictures = ["image/png" in output.get("data", {}) for output in cell["outputs"]]
        assert sum(pictures) == len(plt.get_fignums())


def test_parameters_are_written_in_the_order_of_the_header():
    header = (ROOT / "bindings/c/include/acrobot.h").read_text()
    struct = header[: header.index("} acrobot_params_t;")].rpartition("typedef struct {")[2]
    written = (ROOT / "bindings/c/firmware/plan.h").read_text().split("PARAMS")[1]
    written = re.sub(r"[^\n]*(torque_noise)", r"// torques\n// \1", written)
    names = [*re.findall(r"// (\w+)$", written, re.MULTILINE), "dynamics"]
    assert names == re.findall(r"^  \w+ (\w+)(?:\[3\])?;", struct, re.MULTILINE)
