"""What hatchling does not know by itself: what the package says of its repository, and what of the wheel is compiled.

The wheel brings the bytecode of our macros, which are written in Hy, and of the course. Without it the first start of all takes seconds.
A file of bytecode belongs to one minor version of Python, and has a checksum of what it was made from; any other Python, and one whose
files were changed, compiles as ever. So the wheel is for all of them. The Python that builds compiles; CRAMHY_PYTHONS names others, with
spaces between, which must have Hy. The workflow ``release.yml`` names all that are supported.

The address of the repository is not written down here. Whoever publishes says it in CRAMHY_REPOSITORY, as the workflow
``release.yml`` does, with the version's tag in CRAMHY_TAG. Without it the package has no URLs and README is as it stands.
"""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

from hatchling.build import *  # noqa: F403  this module stands for it, as pyproject.toml says
from hatchling.build import get_requires_for_build_wheel as _required
from hatchling.builders.hooks.plugin.interface import BuildHookInterface
from hatchling.metadata.plugin.interface import MetadataHookInterface

COURSE = ("cram-my-beginner-tutorial", "cram-my-beginner-tutorial-tests")
"""The systems whose files the wheel brings compiled."""
COMPILE = """
import importlib, importlib.util, pathlib, sys
import cramhy
for source in pathlib.Path(cramhy.__file__).parent.glob("*.hy"):
    importlib.import_module(f"cramhy.{source.stem}")
    bytecode = pathlib.Path(importlib.util.cache_from_source(str(source)))
    # it counts while the source has this content, whatever date pip gives it (PEP 552)
    header = importlib.util.MAGIC_NUMBER + (3).to_bytes(4, "little") + importlib.util.source_hash(source.read_bytes())
    bytecode.write_bytes(header + bytecode.read_bytes()[16:])
from cramhy_runtime.session.session import current
from cramhy_runtime.storage import kept_files
kept_files.keep_own_beside()
for system in sys.argv[1:]:
    current().load(system)
"""

PLACES = {"Documentation": "tree/{tag}/docs", "Changes": "blob/{tag}/CHANGELOG.md", "Issues": "issues", "Source": "tree/{tag}"}
LINK = re.compile(r"(!?)\[((?:[^\[\]]|!?\[[^\]]*\](?:\([^)]*\))?)*)\]\((?![a-z]+:|#)([^)\s]+)\)")


def absolute_links(text, repository, tag):
    """Markdown whose links to files of the repository are URLs: pages as GitHub and GitLab show them, pictures as the file itself."""

    def link(match):
        picture, words, target = match.groups()
        kind = "raw" if picture else "blob"
        return f"{picture}[{LINK.sub(link, words)}]({repository}/{kind}/{tag}/{target})"

    return LINK.sub(link, text)


def get_requires_for_build_wheel(config_settings=None):
    """What hatchling needs, and Hy, which compiles. An editable installation compiles nothing."""
    return [*_required(config_settings), "hy>=1.3,<2"]


class Compiled(BuildHookInterface):
    """Puts bytecode into the wheel."""

    def initialize(self, version, build_data):
        """Lay out what the wheel will have, let the Pythons compile it there, and take what they have made."""
        self.stage = None
        if version == "editable":
            return
        self.stage = Path(tempfile.mkdtemp(prefix="cramhy-wheel-"))
        for source, target in (
            ("src/cramhy_runtime", "cramhy_runtime"),
            ("hy_src/cramhy", "cramhy"),
            ("tutorials", "cramhy_runtime/tutorials"),
        ):
            shutil.copytree(Path(self.root, source), self.stage / target, ignore=shutil.ignore_patterns("__pycache__"))
        for python in os.environ.get("CRAMHY_PYTHONS", sys.executable).split():
            self._compile_by(python)
        for made in self.stage.rglob("__pycache__/*"):
            if made.parent.parent.name == "cramhy" and (made.parent.parent / f"{made.name.partition('.')[0]}.hy").exists():
                build_data["force_include"][str(made)] = made.relative_to(self.stage).as_posix()
            elif made.suffix == ".cramhy" and made.is_relative_to(self.stage / "cramhy_runtime" / "tutorials"):
                build_data["force_include"][str(made)] = made.relative_to(self.stage).as_posix()

    def _compile_by(self, python):
        ours = ("PYTHONDONTWRITEBYTECODE", "PYTHONPYCACHEPREFIX", "ROS_PACKAGE_PATH")
        environment = {name: value for name, value in os.environ.items() if name not in ours and not name.startswith("CRAMHY_")}
        environment["PYTHONPATH"] = os.pathsep.join([str(self.stage), *filter(None, [os.environ.get("PYTHONPATH")])])
        done = subprocess.run([python, "-c", COMPILE, *COURSE], cwd=self.stage, env=environment, capture_output=True, text=True)
        if done.returncode:
            raise RuntimeError(f"{python} cannot compile the macros and the course for the wheel:\n{done.stdout}{done.stderr}")

    def finalize(self, version, build_data, artifact_path):
        """Remove what was laid out."""
        if self.stage is not None:
            shutil.rmtree(self.stage, ignore_errors=True)


class Hook(MetadataHookInterface):
    """Gives the package its description and URLs."""

    def update(self, metadata):
        text = (Path(self.root) / "README.md").read_text(encoding="utf-8")
        repository = os.environ.get("CRAMHY_REPOSITORY", "").rstrip("/")
        if repository:
            tag = os.environ.get("CRAMHY_TAG", "main")
            text = absolute_links(text, repository, tag)
            metadata["urls"] = {name: f"{repository}/{place.format(tag=tag)}" for name, place in PLACES.items()}
        metadata["readme"] = {"content-type": "text/markdown", "text": text}
