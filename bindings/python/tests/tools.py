"""What docs/python-many.md says of packages that only a night's CI installs."""

import pytest
from test_docs import run


@pytest.mark.filterwarnings("default")  # those of other packages
def test_videos_and_datasets(capsys, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("MINARI_DATASETS_PATH", str(tmp_path / "minari"))
    run("docs/python-many.md", "python(?: tools)?", capsys)
    assert [*(tmp_path / "videos").glob("*.mp4")]
