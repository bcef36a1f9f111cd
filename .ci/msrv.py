"""Reads what cargo metadata prints of all features, and fails on a dependency of the library that needs a newer Rust than it declares."""

import json
import sys

metadata = json.load(sys.stdin)
packages = {package["id"]: package for package in metadata["packages"]}
nodes = {node["id"]: node for node in metadata["resolve"]["nodes"]}


def version(text):
    return tuple(int(part) for part in text.split("."))


def with_dependencies(package, seen):
    """`package` and all that it is built with, tests and examples aside."""
    if package not in seen:
        seen.add(package)
        for dependency in nodes[package]["deps"]:
            if any(kind["kind"] != "dev" for kind in dependency["dep_kinds"]):
                with_dependencies(dependency["pkg"], seen)
    return seen


root = metadata["resolve"]["root"]
declared = packages[root]["rust_version"]
needs = {packages[id]["name"]: packages[id]["rust_version"] or "0" for id in with_dependencies(root, set())}
newer = {name: rust for name, rust in needs.items() if version(rust) > version(declared)}
if newer:
    sys.exit(f"rust-version is {declared}; these need a newer one: {newer}")
print(f"{len(needs)} packages are content with Rust {declared}")
