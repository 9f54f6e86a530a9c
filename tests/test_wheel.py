"""What is published: the wheel carries the licence, the course, the macros and the page, and PyPI shows a README that leads somewhere.

Without extras the wheel is small, and its prompt does both lectures.
"""

from __future__ import annotations

import json
import os
import re
import runpy
import shutil
import subprocess
import sys
import zipfile
from email.parser import Parser
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]
KERNEL = "share/jupyter/kernels/cramhy/kernel.json"


REPOSITORY = "https://example.org/robots/cramhy"


@pytest.fixture(scope="module")
def dist(tmp_path_factory):
    """The folder with the sdist of this tree and the wheel made of it, as ``release.yml`` builds them."""
    for module in ("hatchling", "build"):
        pytest.importorskip(module, reason=f"the wheel is built with it: pip install {module}")
    folder = tmp_path_factory.mktemp("dist")
    subprocess.run(
        [sys.executable, "-m", "build", "--no-isolation", "--outdir", str(folder), str(ROOT)],
        check=True,
        capture_output=True,
        env={**os.environ, "CRAMHY_REPOSITORY": REPOSITORY, "CRAMHY_TAG": "v0"},
    )
    return folder


@pytest.fixture(scope="module")
def wheel(dist):
    """The wheel, opened."""
    (path,) = dist.glob("*.whl")
    with zipfile.ZipFile(path) as opened:
        yield opened


def file_called(wheel, ending):
    """The text of the one file of the wheel whose name ends so."""
    (name,) = [name for name in wheel.namelist() if name.endswith(ending)]
    return wheel.read(name).decode()


def test_the_wheel_carries_the_licence(wheel):
    assert file_called(wheel, ".dist-info/licenses/LICENSE") == (ROOT / "LICENSE").read_text()
    metadata = Parser().parsestr(file_called(wheel, ".dist-info/METADATA"))
    assert (metadata["License-Expression"], metadata.get_all("License-File")) == ("BSD-3-Clause", ["LICENSE"])


@pytest.mark.soak
def test_twine_accepts_both(dist):
    pytest.importorskip("twine", reason="it checks what is published: pip install twine")
    done = subprocess.run([sys.executable, "-m", "twine", "check", "--strict", *map(str, dist.iterdir())], capture_output=True, text=True)
    assert done.returncode == 0 and done.stdout.count("PASSED") == 2, done.stdout + done.stderr


def test_each_link_and_picture_of_the_description_is_a_url(wheel):
    metadata = Parser().parsestr(file_called(wheel, ".dist-info/METADATA"))
    text = re.sub(r"^```.*?^```", "", metadata.get_payload(), flags=re.M | re.S)
    targets = re.findall(r"\]\(([^)\s]+)\)", text)
    assert len(targets) > 10
    assert not [target for target in targets if not re.match("https?:|#", target)]
    ours = [target.removeprefix(REPOSITORY) for target in targets if target.startswith(REPOSITORY)]
    for target in ours:
        kind, tag, path = re.fullmatch(r"/(blob|raw)/(v0)/([^#]+)(?:#.*)?", target).groups()
        assert (ROOT / path).exists() and (kind == "raw") == path.endswith((".png", ".svg", ".gif")), target
    assert [url.partition(", ")[0] for url in metadata.get_all("Project-URL")] == ["Documentation", "Changes", "Issues", "Source"]


def test_the_metadata_say_for_whom_it_is(wheel):
    metadata = Parser().parsestr(file_called(wheel, ".dist-info/METADATA"))
    assert metadata["Author"] == "cramhy contributors" and metadata["Summary"]
    classifiers = metadata.get_all("Classifier")
    assert {"Intended Audience :: Education", "Intended Audience :: Science/Research", "Framework :: Pytest"} <= set(classifiers)


def test_changes_and_citation_name_this_version(wheel):
    version = Parser().parsestr(file_called(wheel, ".dist-info/METADATA"))["Version"]
    assert re.search(rf"^## {re.escape(version)}\b", (ROOT / "CHANGELOG.md").read_text(), re.M)
    assert f"\nversion: {version}\n" in (ROOT / "CITATION.cff").read_text()


def test_the_licence_names_its_holders():
    text = (ROOT / "LICENSE").read_text()
    assert text.startswith("BSD 3-Clause License\n\nCopyright (c) 2026, cramhy contributors\n")
    assert all(f"\n{number}. " in text for number in (1, 2, 3))


def test_the_manifest_of_the_course_names_the_same_licence():
    assert "<license>BSD-3-Clause</license>" in (ROOT / "tutorials/cram_my_beginner_tutorial/package.xml").read_text()


def test_the_wheel_teaches_the_course(unpacked):
    """Its pages are there, and `cramhy learn` shows the first one."""
    site, _ = unpacked
    environment = {**os.environ, "PYTHONPATH": str(site), "HOME": str(site.parent), "CRAMHY_HISTORY": ""}
    words = [sys.executable, "-m", "cramhy_runtime.cli", "learn"]
    done = subprocess.run(words, cwd=site.parent, env=environment, input=":pages\n:quit\n", capture_output=True, text=True, timeout=100)
    assert done.returncode == 0 and "Your first forms" in done.stdout and "12  Tests" in done.stdout, done.stdout + done.stderr


@pytest.mark.parametrize("folder", ["src/cramhy_runtime", "hy_src/cramhy", "tutorials"])
def test_the_wheel_has_every_file_of_the_tree(wheel, folder):
    tracked = subprocess.run(["git", "ls-files", folder], cwd=ROOT, capture_output=True, text=True)
    if tracked.returncode or not tracked.stdout:
        pytest.skip("this tree is no clone of git's, so what belongs to it is not known")
    home = "cramhy_runtime/tutorials" if folder == "tutorials" else folder.partition("/")[2]
    assert {home + name.removeprefix(folder) for name in tracked.stdout.splitlines()} <= set(wheel.namelist())


def test_an_editable_installation_has_no_copies(tmp_path):
    """A copy of the tutorials would age, and pytest would take their packages for plugins."""
    pytest.importorskip("hatchling", reason="the wheel is built with it: pip install hatchling")
    subprocess.run(
        [sys.executable, "-m", "hatchling", "build", "-t", "wheel:editable", "-d", str(tmp_path)], cwd=ROOT, check=True, capture_output=True
    )
    (path,) = tmp_path.glob("*.whl")
    with zipfile.ZipFile(path) as opened:
        names = {name for name in opened.namelist() if ".dist-info/" not in name}
    assert {name.rpartition(".data/data/")[2] for name in names} == {"_cramhy.pth", KERNEL}


FIRST_START = """
import importlib, pathlib, sys
from cramhy_runtime.repl.session import Session
from cramhy_runtime.languages.commonlisp.systems import loader
session = Session(time="virtual")
session.load("cram-my-beginner-tutorial")
print([str(why) for why in loader._not_used.values()], "hy" in sys.modules)
import hy.importer
compiled = []
compile = hy.importer.hy_compile
hy.importer.hy_compile = lambda tree, name, *more, **others: (compiled.append(str(name)), compile(tree, name, *more, **others))[1]
import cramhy
for source in pathlib.Path(cramhy.__file__).parent.glob("*.hy"):
    importlib.import_module(f"cramhy.{source.stem}")
print(compiled)
"""


@pytest.fixture
def unpacked(wheel, tmp_path):
    """The wheel as pip lays it out, with the date of now; what it prints when it is started."""
    pytest.importorskip("hy")
    for name in wheel.namelist():
        if name.startswith(("cramhy/", "cramhy_runtime/")):
            target = tmp_path / "site" / name
            target.parent.mkdir(parents=True, exist_ok=True)
            target.write_bytes(wheel.read(name))

    def started():
        environment = {**os.environ, "PYTHONPATH": str(tmp_path / "site"), "HOME": str(tmp_path)}
        environment.pop("PYTHONDONTWRITEBYTECODE", None)
        done = subprocess.run([sys.executable, "-c", FIRST_START], cwd=tmp_path, env=environment, capture_output=True, text=True)
        assert (done.returncode, done.stderr) == (0, "")
        return done.stdout.splitlines()

    return tmp_path / "site", started


@pytest.mark.soak
def test_the_first_start_of_the_wheel_compiles_no_macros_and_no_course_unless_they_were_changed(unpacked):
    site, started = unpacked
    assert started() == ["[] False", "[]"]
    folder = site / "cramhy_runtime" / "tutorials" / "cram_my_beginner_tutorial" / "src"
    [cut] = site.parent.glob(".cache/cramhy/*-package.hy.*.cramhy")  # which knows where the wheel was unpacked
    cut.write_bytes(cut.read_bytes()[:-10])
    (folder / "conditions.hy").write_bytes((folder / "conditions.hy").read_bytes() + b";; mine\n")
    (site / "cramhy" / "cpm.hy").write_bytes((site / "cramhy" / "cpm.hy").read_bytes() + b";; mine\n")
    first = started()
    assert "False" not in first[0] and "is damaged" in first[0] and "was made from something else" in first[0]
    assert first[1] == "[]", "what was changed was compiled for the course, and kept"
    assert started() == ["[] False", "[]"]


def test_the_wheel_tells_jupyter_of_the_kernel(wheel):
    description = json.loads(file_called(wheel, f".data/data/{KERNEL}"))
    assert description["argv"][:5] == ["python", "-m", "cramhy_runtime.cli", "jupyter", "kernel"]


def without_cramhy(home):
    """The variables of a user whose home is empty, and who has no cramhy on the path."""
    kept = {
        key: value for key, value in os.environ.items() if key in ("PATH", "LANG", "SYSTEMROOT") or key.startswith(("PIP_", "UV_", "SSL_"))
    }
    return {**kept, "HOME": str(home), "USERPROFILE": str(home), "XDG_RUNTIME_DIR": str(home)}


@pytest.fixture(scope="module")
def environment(dist, wheel, tmp_path_factory):
    """The folder of an environment that has the wheel without extras, and what pip fetches for it."""
    folder = tmp_path_factory.mktemp("empty") / "venv"
    subprocess.run([sys.executable, "-m", "venv", str(folder)], check=True)
    pip = [str(program(folder, "python")), "-m", "pip", "install", "--quiet", "--disable-pip-version-check"]
    asked = Parser().parsestr(file_called(wheel, ".dist-info/METADATA")).get_all("Requires-Dist")
    fetched = subprocess.run([*pip, *(one for one in asked if "extra ==" not in one)], capture_output=True, text=True)
    if fetched.returncode:
        pytest.skip(f"what the wheel needs cannot be fetched here: {fetched.stderr.strip().splitlines()[-1]}")
    subprocess.run([*pip, "--no-index", *map(str, dist.glob("*.whl"))], check=True)
    return folder


def program(environment, name):
    """The path of a program of an environment."""
    return program_in(environment / ("Scripts" if os.name == "nt" else "bin"), name)


def program_in(folder, name):
    """The path of a program in a folder of programs."""
    return folder / (f"{name}.exe" if os.name == "nt" else name)


def check_lectures(repl, home):
    """Type the lines of both lectures into the program REPL, in the folder HOME, and look at its answers."""
    lectures = runpy.run_path(str(ROOT / "tutorials" / "lectures.py"))
    lines = [*lectures["LECTURE_34"], *lectures["LECTURE_38"], "(value *turtle-pose*)", '(turtlesim:save-paper "turtle.png")']
    done = subprocess.run(
        [str(repl), "--time", "virtual"],
        input="\n".join(lines) + "\n",
        cwd=home,
        env=without_cramhy(home),
        capture_output=True,
        text=True,
        timeout=300,
    )
    assert (done.returncode, done.stderr) == (0, "") and "debugger" not in done.stdout, done.stdout + done.stderr
    assert done.stdout.count("Node startup complete") == 2 and done.stdout.count("TurtleSim pen control invoked") == 10
    pose = re.findall(r"X:\s+([\d.]+)d0\s+Y:\s+([\d.]+)d0", done.stdout)
    assert pose[0] == ("5.544444561004639", "5.544444561004639") and [round(float(number)) for number in pose[-1]] == [9, 9]
    assert (home / "turtle.png").read_bytes().startswith(b"\x89PNG")


@pytest.mark.soak
def test_an_empty_environment_with_the_wheel_is_small(environment):
    size = sum(path.lstat().st_size for path in environment.rglob("*"))
    assert size < 65 * 2**20


@pytest.mark.soak
def test_the_prompt_of_the_wheel_without_extras_does_both_lectures(environment, tmp_path):
    for extra in ("prompt_toolkit", "uvicorn", "greenlet"):
        assert subprocess.run([str(program(environment, "python")), "-c", f"import {extra}"], capture_output=True).returncode
    check_lectures(program(environment, "roslisp_repl"), tmp_path)


@pytest.mark.soak
@pytest.mark.parametrize(
    ("tool", "command", "homes"),
    [
        ("uv", ["tool", "install", "--python", sys.executable, str(ROOT)], ("UV_TOOL_DIR", "UV_TOOL_BIN_DIR", "UV_CACHE_DIR")),
        ("pipx", ["install", "--python", sys.executable, str(ROOT)], ("PIPX_HOME", "PIPX_BIN_DIR", "PIPX_MAN_DIR")),
    ],
    ids=["uv", "pipx"],
)
def test_a_tool_that_installs_programs_gives_a_prompt_that_does_both_lectures(environment, tool, command, homes, tmp_path):
    found = shutil.which(tool)
    if found is None:
        pytest.skip(f"{tool} is not installed: pip install {tool}")
    folders = {name: str(tmp_path / name) for name in homes}
    done = subprocess.run([found, *command], env={**without_cramhy(tmp_path), **folders}, capture_output=True, text=True, timeout=300)
    assert done.returncode == 0, done.stdout + done.stderr
    home = tmp_path / "home"
    home.mkdir()
    check_lectures(program_in(Path(folders[homes[1]]), "roslisp_repl"), home)
