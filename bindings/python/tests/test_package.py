"""The installed package has what a registry shows."""

import sys
import sysconfig
from importlib.metadata import distribution

import acrobot_rs
import pytest


def test_metadata():
    package = distribution("acrobot-rs")
    metadata = package.metadata
    assert acrobot_rs.__version__ == metadata["Version"]
    assert metadata["License-Expression"] == "MIT OR Apache-2.0"
    assert metadata["Requires-Python"] == ">=3.10"
    assert sorted(package.requires) == ["gymnasium>=1.1", "numpy>=1.26"]
    # Not the README of the crate, which is in the source distribution too.
    text = metadata["Description"] or metadata.get_payload()
    assert text.lstrip().startswith("# Acrobot for Gymnasium")


def test_files():
    files = {path.name: path for path in distribution("acrobot-rs").files}
    assert "py.typed" in files
    words = {
        "LICENSE-MIT": "Permission is hereby granted",
        "LICENSE-APACHE": "Version 2.0, January",
    }
    for name in words:
        assert files[name].parent.name == "licenses"
        assert words[name] in files[name].read_text()


@pytest.mark.skipif(not sysconfig.get_config_var("Py_GIL_DISABLED"), reason="needs free threads")
def test_the_import_brings_back_no_lock():
    assert not sys._is_gil_enabled()
