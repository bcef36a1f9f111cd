"""mypy and pyright accept the code of the guide, and find mistakes."""

import re
import subprocess
import sys

import pytest
from test_docs import NAMES, ROOT

PROGRAM = """\
import acrobot_rs

swingups = acrobot_rs.AcrobotSwingupVectorEnv(2, copy=False, DAMPING_1=[0.0, 0.1])
print(swingups.get_attr("state"), swingups.elapsed_steps.sum())


class Heavy(acrobot_rs.AcrobotVectorEnv):
    LINK_MASS_1 = 2.0
    LINK_MASS_2 = acrobot_rs.Uniform(1.0, 2.0)
"""
WRONG = """\
import acrobot_rs

env = acrobot_rs.AcrobotEnv()
env.LINK_MAS_1 = 1.0
print(env._terminal)
env.reset(seed="1")
acrobot_rs.AcrobotVectorEnv(2, copy=None)
"""


@pytest.mark.parametrize(
    "checker",
    [
        ["mypy", "--strict", "--ignore-missing-imports", "--no-error-summary"],
        ["pyright", "--pythonpath", sys.executable],
    ],
    ids=lambda each: each[0],
)
def test_checkers(checker, tmp_path):
    pytest.importorskip(checker[0])
    texts = {"program.py": PROGRAM, "wrong.py": WRONG}
    for name in NAMES:
        page = (ROOT / f"docs/{name}.md").read_text()
        blocks = re.findall(r"^```py(?:thon)?\n(.*?)^```", page, re.MULTILINE | re.DOTALL)
        options = (
            "# pyright: reportMissingImports=false\n# mypy: allow-untyped-defs, allow-untyped-calls"
        )
        texts[f"{name}.py"] = "\n".join([options, *blocks])
    for name, text in texts.items():
        (tmp_path / name).write_text(text)
    run = subprocess.run(
        [sys.executable, "-m", *checker, *texts], cwd=tmp_path, capture_output=True, text=True
    )
    errors = re.findall(r"(\w+\.py):(\d+):.*error", run.stdout)
    assert {name for name, _ in errors} == {"wrong.py"}, run.stdout + run.stderr
    assert {int(line) for _, line in errors} == set(range(4, 1 + WRONG.count("\n"))), run.stdout
