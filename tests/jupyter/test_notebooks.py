"""The tutorial as notebooks: made of its pages, and executed as ``jupyter nbconvert --execute`` does."""

from __future__ import annotations

import json
import os
import sys
from pathlib import Path

import pytest

sys.path.insert(0, str(Path(__file__).parents[1]))

for module in ("ipykernel", "nbclient", "nbformat"):
    pytest.importorskip(module, reason=f"notebooks are run with it: pip install {module}")

from cramhy_runtime.jupyter import kernelspec  # noqa: E402

sys.path.insert(0, str(Path(__file__).parents[2]))
from tests.docs import notebooks  # noqa: E402


@pytest.fixture
def jupyter(tmp_path, monkeypatch):
    """Jupyter knows the kernel, and starts it in the folder."""
    kernelspec.install(prefix=tmp_path / "env")
    monkeypatch.setenv("JUPYTER_PATH", str(tmp_path / "env" / "share" / "jupyter"))
    monkeypatch.delenv("PYTHONDONTWRITEBYTECODE", raising=False)
    return tmp_path


def executed(page, folder, language="lisp"):
    import nbclient

    made = notebooks.notebook(page, language)
    client = nbclient.NotebookClient(made, timeout=300, startup_timeout=200, kernel_name="cramhy", resources={"metadata": {"path": folder}})
    return client.execute()


def outputs(cell):
    return [output for output in cell["outputs"] if output["output_type"] != "stream"]


def test_the_notebook_of_lecture_34_runs_and_shows_the_turtle(jupyter):
    place = jupyter / "ros" / "src"
    place.mkdir(parents=True)
    done = executed(notebooks.TUTORIALS / "lecture-34.md", str(place))
    assert (place / "cram_my_beginner_tutorial" / "src" / "control-turtlesim.lisp").exists()
    code = [cell for cell in done.cells if cell.cell_type == "code"]
    shown = [output for cell in code for output in outputs(cell)]
    assert any("image/svg+xml" in output["data"] for output in shown if output["output_type"] == "display_data")
    failed = [cell for cell in code if any(output["output_type"] == "error" for output in cell["outputs"])]
    assert [cell.source for cell in failed] == [cell.source for cell in code if cell.metadata.get("tags")] == ["(value turtle-pose)"]
    assert (place / "lecture-34.svg").read_text() == (notebooks.TUTORIALS / "lecture-34.svg").read_text()  # as the site shows it


@pytest.mark.soak
@pytest.mark.parametrize("language", ["lisp", "hy"])
def test_the_notebooks_of_all_lectures_run_one_after_the_other(jupyter, language):
    place = jupyter / "ros" / "src"
    place.mkdir(parents=True)
    for page in notebooks.PAGES if language == "lisp" else [page for page in notebooks.PAGES if page in notebooks.IN_HY]:
        executed(page, str(place), language)  # a cell that fails, and is not said to, ends it


@pytest.mark.soak
@pytest.mark.parametrize("language", ["lisp", "hy"])
@pytest.mark.parametrize("page", notebooks.MORE, ids=lambda page: page.stem)
def test_the_notebooks_of_the_other_pages_run(jupyter, page, language):
    if page.parent.name == "kitchen":
        pytest.importorskip("mujoco", reason="needs MuJoCo (mujoco-core)")
    if language == "hy" and page not in notebooks.IN_HY:
        pytest.skip("the page has no session in Hy")
    notebooks.prepare(jupyter / "place", page)
    done = executed(page, str(jupyter / "place"), language)
    code = [cell for cell in done.cells if cell.cell_type == "code"]
    failed = [cell.source for cell in code if any(output["output_type"] == "error" for output in cell["outputs"])]
    assert failed == [cell.source for cell in code if cell.metadata.get("tags")]
    if page.parent.name == "kitchen":
        shown = [output for cell in code for output in outputs(cell) if output["output_type"] == "display_data"]
        assert any("image/png" in output["data"] for output in shown), "the robot's world has changed"


@pytest.mark.soak
def test_all_pages_of_the_tutorials_are_notebooks(tmp_path):
    written = {path.relative_to(tmp_path).as_posix() for path in notebooks.write(tmp_path)}
    pages = {path.stem for path in notebooks.TUTORIALS.rglob("*.md")} - {"index", "the-package"}
    assert {Path(name).stem.removesuffix("-in-hy") for name in written} == pages
    assert {"lectures/lecture-34.ipynb", "turtle/first-plan-in-hy.ipynb", "kitchen/table-for-two.ipynb"} <= written
    assert (tmp_path / "turtle" / "turtlesim_in_hy").is_dir() and (tmp_path / "kitchen" / "kitchen_in_hy").is_dir()
    first = json.loads((tmp_path / "turtle" / "first-plan-in-hy.ipynb").read_text())
    code = ["".join(cell["source"]) for cell in first["cells"] if cell["cell_type"] == "code"]
    assert code[0] == "(in-hy)" and not any("CL-USER>" in text or "=> " in text for text in code)


def test_each_thing_typed_is_a_cell_and_what_the_debugger_hears_is_none():
    text = (
        'Words.\n```lisp title="a/b.lisp"\n(list)\n```\nMore.\n```lisp\nCL-USER> (car 1)\nTYPE-ERROR\n0] 0\nCL-USER> (list\n1)\n(1)\n```\n'
    )
    assert notebooks.cells(text) == [
        ("markdown", "Words.", False),
        ("code", "%%writefile a/b.lisp\n(list)", False),
        ("markdown", "More.", False),
        ("code", "(car 1)", True),
        ("code", "(list\n1)", False),
    ]


def test_the_description_in_the_wheel_is_that_which_is_installed(tmp_path):
    stored = json.loads((Path(kernelspec.__file__).parent / "kernel.json").read_text())
    assert stored == kernelspec.described()
    path = kernelspec.install(prefix=tmp_path, time="wall")
    words = json.loads(path.read_text())["argv"]
    assert words[0] == sys.executable and words[-4:] == ["--time", "wall", "-f", "{connection_file}"]
    assert kernelspec.uninstall(prefix=tmp_path) and not path.exists() and not kernelspec.uninstall(prefix=tmp_path)


def test_a_kernel_of_somebody_else_is_not_removed(tmp_path):
    place = kernelspec.folder(tmp_path)
    place.mkdir(parents=True)
    (place / "kernel.json").write_text('{"argv": ["other"]}')
    with pytest.raises(FileExistsError):
        kernelspec.uninstall(prefix=tmp_path)
    assert os.listdir(place) == ["kernel.json"]
