"""The Python code in docs/python.md and in the README runs, prints what its comments say, and all links lead to files."""

import re
from pathlib import Path

import pytest

PACKAGE = Path(__file__).resolve().parents[1]
DOCUMENTS = [PACKAGE.parents[1] / "docs/python.md", PACKAGE / "README.md"]
PAGES = pytest.mark.parametrize("page", DOCUMENTS, ids=lambda page: page.name)


@PAGES
def test_code_runs_and_prints_what_its_comments_say(page, capsys):
    blocks = re.findall(r"^```python\n(.*?)^```", page.read_text(), re.MULTILINE | re.DOTALL)
    assert blocks
    # A reader runs all blocks of a page in one session.
    session = {}
    for block in blocks:
        exec(compile(block, page, "exec"), session)
        assert capsys.readouterr().out.splitlines() == re.findall(r"^# prints (.*)", block, re.MULTILINE)


@PAGES
def test_links_lead_to_files(page):
    links = re.findall(r"\]\((?!https:|#)([^)#]+)", page.read_text())
    assert links
    for link in links:
        assert (page.parent / link).exists(), link
