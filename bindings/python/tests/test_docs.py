"""The Python code of the documentation runs, and prints what its comments say."""

import re
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[3]


NAMES = "python", "python-control", "python-many", "python-parameters", "swingup", "gradients"
PAGES = ["README.md", "bindings/python/README.md", *(f"docs/{name}.md" for name in NAMES)]


@pytest.mark.parametrize("name", PAGES)
def test_code_runs_and_prints_what_its_comments_say(name, capsys, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    page = ROOT / name
    blocks = re.findall(r"^```python\n(.*?)^```", page.read_text(), re.MULTILINE | re.DOTALL)
    assert blocks
    # A reader runs all blocks of a page in one session.
    session = {}
    for block in blocks:
        exec(compile(block, page, "exec"), session)
        assert capsys.readouterr().out.splitlines() == re.findall(
            r"^# prints (.*)", block, re.MULTILINE
        )
