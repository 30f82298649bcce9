# SPDX-License-Identifier: GPL-3.0-or-later
"""The package: types, docstrings, examples, notebook, memory, installation."""

import ast
import inspect
import os
import pathlib
import re
import subprocess
import sys

import numpy as np
import pytest

import hullslam
from conftest import ROOT, run_program
from hullslam import _core

PYTHON = ROOT / "python"


def run(*command, **keywords):
    result = subprocess.run([sys.executable, *map(str, command)], capture_output=True, text=True,
                            check=False, **keywords)
    assert result.returncode == 0, result.stdout + result.stderr
    return result.stdout


def test_the_stubs_are_up_to_date():
    run(ROOT / "scripts" / "generate_python_stubs.py", "--check")


def test_the_stubs_fit_the_module():
    pytest.importorskip("mypy")
    result = subprocess.run([sys.executable, "-m", "mypy.stubtest", "hullslam._core", "--concise"],
                            capture_output=True, text=True, check=False)
    # pybind11 gives all classes a metaclass, and constructors to those that have none.
    known = ("metaclass differs", "__init__ is inconsistent, stub does not have *args")
    lines = result.stdout.splitlines()
    assert any(known[0] in line for line in lines), result.stdout + result.stderr
    assert [line for line in lines if not any(text in line for text in known)] == []


def test_the_examples_have_the_types_of_the_stubs(tmp_path):
    pytest.importorskip("mypy")
    (tmp_path / "good.py").write_text(README_EXAMPLE)
    (tmp_path / "bad.py").write_text("import hullslam\n"
                                     "hullslam.Settings().tracking.min_inliers = 'a'\n")
    command = [sys.executable, "-m", "mypy", "--cache-dir", tmp_path / "cache",
               "--ignore-missing-imports"]
    run(*command[1:], tmp_path / "good.py", PYTHON / "examples" / "video.py",
        *sorted((ROOT / "Examples" / "library").glob("*.py")))
    bad = subprocess.run([*command, tmp_path / "bad.py"], capture_output=True, text=True, check=False)
    assert bad.returncode == 1 and 'expression has type "str", variable has type "int"' in bad.stdout


def test_everything_public_has_a_docstring():
    for name in hullslam.__all__:
        thing = getattr(hullslam, name)
        if name != "__version__":
            assert thing.__doc__, name
        if inspect.isclass(thing):
            for member, value in vars(thing).items():
                if not member.startswith("_"):
                    assert value.__doc__, f"{name}.{member}"


def test_the_stubs_have_docstrings():
    for name in ("_core.pyi", "_settings.pyi"):
        tree = ast.parse((PYTHON / "hullslam" / name).read_text(encoding="utf-8"))
        for node in tree.body:
            if isinstance(node, ast.ClassDef) and node.name in hullslam.__all__:
                assert ast.get_docstring(node), node.name
    assert "Finds the pose of the camera" in (PYTHON / "hullslam" / "_core.pyi").read_text(encoding="utf-8")


def blocks_of(document):
    text = (ROOT / document).read_text(encoding="utf-8")
    return re.findall(r"^```python\n(.*?)^```", text, re.MULTILINE | re.DOTALL)


README_EXAMPLE = blocks_of("docs/python.md")[0]


def test_the_example_of_the_documents_is_short():
    assert len(README_EXAMPLE.splitlines()) <= 30


@pytest.fixture
def documented_folder(desk, tmp_path, monkeypatch):
    """The working directory that the documents assume."""
    (tmp_path / "data").mkdir()
    (tmp_path / "data" / "rgbd_dataset_freiburg1_xyz").symlink_to(desk)
    (tmp_path / "config").symlink_to(ROOT / "config")
    run_program("rgbd_tum", desk, "--masks", desk / "masks", "--output", tmp_path / "out", "--quiet")
    monkeypatch.chdir(tmp_path)
    return tmp_path


@pytest.mark.parametrize("document", ["docs/python.md", "README.md"])
def test_the_examples_of_the_documents_run(document, documented_folder):
    red_network = pytest.importorskip("red_network")
    red_network.write_red_network(documented_folder / "yolov8n-seg.onnx")
    (documented_folder / "TUM1.yaml").symlink_to(ROOT / "config" / "TUM1.yaml")
    # Names that README.md does not explain.
    names = {"hullslam": hullslam, "image": np.zeros((480, 640), np.uint8),
             "depth": np.zeros((480, 640), np.uint16), "masks": None}
    assert blocks_of(document)
    for block in blocks_of(document):
        exec(compile(block, document, "exec"), names)  # the blocks of a page follow one another


def test_the_example_of_a_video(desk, tmp_path):
    cv2 = pytest.importorskip("cv2")
    settings = hullslam.Settings(desk / "camera.yaml")
    video = cv2.VideoWriter(str(tmp_path / "a.avi"), cv2.VideoWriter_fourcc(*"MJPG"), 30,
                            settings.image_size)
    for frame in hullslam.open_tum(desk, settings, depth=False):
        video.write(cv2.cvtColor(frame.image, cv2.COLOR_GRAY2BGR))
    video.release()
    example = PYTHON / "examples" / "video.py"
    command = [sys.executable, example, tmp_path / "a.avi", "--settings", desk / "camera.yaml",
               "--output", tmp_path / "a.txt"]
    result = subprocess.run(command, capture_output=True, text=True, check=False)
    # Whether 25 frames are enough for a monocular map is not what is tested here.
    if result.returncode == 0:
        assert (tmp_path / "a.txt").exists()
    else:
        assert "error: no map could be made: " in result.stderr
    result = subprocess.run([*command, "--model", "a.pt"], capture_output=True, text=True, check=False)
    assert result.returncode == 1 and "pip install ultralytics" in result.stderr


def test_the_notebook_runs(desk, tmp_path):
    nbformat = pytest.importorskip("nbformat")
    pytest.importorskip("ipykernel")
    preprocessors = pytest.importorskip("nbconvert.preprocessors")
    notebook = nbformat.read(PYTHON / "examples" / "objects.ipynb", as_version=4)
    os.environ["HULLSLAM_SEQUENCE"] = str(desk)
    preprocessors.ExecutePreprocessor(timeout=60, kernel_name="python3").preprocess(
        notebook, {"metadata": {"path": str(tmp_path)}})
    outputs = [output for cell in notebook.cells for output in cell.get("outputs", [])]
    assert any("image/png" in output.get("data", {}) for output in outputs)


def test_the_memory_does_not_grow_with_the_frames():
    run(ROOT / "bench" / "python_growth.py", "--frames", 1000, "--most", 4000)


def test_the_version_is_that_of_the_programs():
    assert hullslam.__version__ in run_program("rgbd_tum", "--version")


def test_the_installed_package_can_be_imported(tmp_path):
    build = pathlib.Path(_core.__file__).parents[2]
    subprocess.run(["cmake", "--install", build, "--component", "python", "--prefix", tmp_path],
                   check=True, capture_output=True)
    (package,) = tmp_path.rglob("hullslam/__init__.py")
    environment = {**os.environ, "PYTHONPATH": str(package.parents[1])}
    printed = run("-c", "import hullslam; print(hullslam.__file__); print(hullslam.Settings("
                  "hullslam.default_settings('fr1_a')).image_size)", env=environment, cwd=tmp_path)
    assert printed.splitlines() == [str(package), "(640, 480)"]
    assert {path.name for path in package.parent.iterdir()} >= {"py.typed", "_core.pyi",
                                                                "_settings.pyi", "_settings.py"}


def test_without_numpy_the_error_names_it():
    program = ("import sys; sys.modules['numpy'] = None\n"
               "try:\n    import hullslam\nexcept ImportError as error:\n    print(error)\n")
    assert "hullslam needs numpy, which " in run("-c", program)
