"""The stub says what the compiled part has."""

import ast
from pathlib import Path

import denavit
from denavit import _denavit

STUB = Path(denavit.__file__).with_name("_denavit.pyi")


def test_the_stub_and_the_module_have_the_same_names():
    tree = ast.parse(STUB.read_text())
    kinds = (ast.FunctionDef, ast.ClassDef)
    names = {node.name for node in tree.body if isinstance(node, kinds)}
    there = {name for name in vars(_denavit) if not name.startswith("__")}
    assert names == there
    (model,) = [node for node in tree.body if isinstance(node, ast.ClassDef)]
    methods = {node.name for node in model.body if isinstance(node, ast.FunctionDef)}
    there = {name for name in vars(_denavit.Model) if not name.startswith("__")}
    assert methods - {"__new__"} == there


def test_everything_public_is_documented():
    for name in denavit.__all__:
        one = getattr(denavit, name)
        if isinstance(one, type) or type(one).__name__ == "function":
            assert one.__doc__, name
    for name, one in vars(_denavit.Model).items():
        if not name.startswith("_"):
            assert one.__doc__, name


def test_the_package_is_typed():
    assert Path(denavit.__file__).with_name("py.typed").exists()
