#!/usr/bin/env python3
"""Puts the repository's address into each file that needs it, and the registries' packages into the installation guides.

    python3 .ci/address.py https://github.com/OWNER/NAME    # writes, also over an older address
    python3 .ci/address.py                                  # checks that all places have the same address, or none
"""

import re
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
URL = re.compile(r"https://github\.com/[\w-]+/[\w.-]+")

# A text without an address, and the text with it.
PLACES = {
    "Cargo.toml": [('readme = "README.md"\n', 'readme = "README.md"\nrepository = "URL"\n')],
    "CITATION.cff": [("license:\n", 'repository-code: "URL"\nlicense:\n')],
    "CONTRIBUTING.md": [("(REPOSITORY)", "(URL)")],
    "README.md": [
        ("# acrobot\n", "# acrobot\n\n[![checks](URL/actions/workflows/ci.yml/badge.svg)](URL/actions/workflows/ci.yml)\n"),
        ("In a package beside a clone of this repository, `cargo add acrobot --path ../acrobot` adds the\ncrate; after publication, `cargo add acrobot`.",
         "`cargo add acrobot` adds the crate to a package."),
        ("In the clone, on two cores", "In a clone of URL, on two cores"),
    ],
    "docs/c.md": [("in a clone of this repository", "in a clone of URL")],
    "docs/embedded.md": [(' # until it is published: { path = "../acrobot" }', "")],
    "docs/python.md": [
        ("The package is not on PyPI yet. Install it from a clone of this repository, in a virtual environment", "In a virtual environment"),
        ("pip install ./examples/python    # compiles for one to four minutes\n```\n\nThis needs",
         "pip install acrobot-rs\n```\n\nFrom a clone of URL, it is `pip install ./examples/python`, which compiles for one to four minutes. This needs"),
    ],
    "docs/rust.md": [('# Until it is published: acrobot = { path = "../acrobot", features = ["std"] }\n', "")],
    "docs/wasm.md": [
        ("Until it is published, pack it in a clone of this\nrepository", "Install it by `npm install acrobot-rs`, or pack it in a\nclone of URL"),
        ("    # after publication: npm install acrobot-rs", ""),
        (' # until it is published: { path = "../acrobot" }', ""),
    ],
    "examples/c/arduino/library.properties": [("url=https://gymnasium.farama.org/environments/classic_control/acrobot/\n", "url=URL\n")],
    "examples/npm/package/package.json": [
        ('  "keywords"', '  "repository": { "type": "git", "url": "git+URL.git", "directory": "examples/npm" },\n  "keywords"'),
    ],
    "examples/python/pyproject.toml": [
        ("# The first release adds [project.urls].\n",
         '\n[project.urls]\nRepository = "URL"\nDocumentation = "URL/blob/main/docs/python.md"\nChangelog = "URL/blob/main/CHANGELOG.md"\nIssues = "URL/issues"\n'),
    ],
    "examples/python/README.md": [
        ("pip install .    # in this folder; needs Python 3.10 or later and Rust 1.89 or later", "pip install acrobot-rs"),
        ("(../../docs/python.md)", "(URL/blob/main/docs/python.md)"),
    ],
}


def main():
    address = sys.argv[1] if len(sys.argv) > 1 else None
    if address and not URL.fullmatch(address):
        sys.exit(f"the address must be https://github.com/OWNER/NAME, got {address}")
    manifest = (ROOT / "Cargo.toml").read_text()
    present = re.search(rf'^repository = "({URL.pattern})"$', manifest, re.MULTILINE)
    present = present and present[1]
    texts, wrong = {}, []
    for file, places in PLACES.items():
        text = (ROOT / file).read_text()
        for without, with_address in places:
            old = with_address.replace("URL", present) if present else without
            if old and text.count(old) != 1:
                wrong.append(f"{file} must have once, as {'written by' if present else 'replaced by'} .ci/address.py: {old!r}")
            if not old and without in text:
                wrong.append(f"{file} must not have any longer: {without!r}")
            if address and old:
                text = text.replace(old, with_address.replace("URL", address))
        texts[file] = text
    if wrong:
        sys.exit("\n".join(wrong))
    if address:
        for file, text in texts.items():
            (ROOT / file).write_text(text)


main()
