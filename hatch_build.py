"""What the built package says of its repository: its URLs, and links of README that lead somewhere from PyPI, too.

The address of the repository is not written down here. Whoever publishes says it in CRAMHY_REPOSITORY, as the workflow
``release.yml`` does, with the version's tag in CRAMHY_TAG. Without it the package has no URLs and README is as it stands.
"""

from __future__ import annotations

import os
import re
from pathlib import Path

from hatchling.metadata.plugin.interface import MetadataHookInterface

PLACES = {"Documentation": "tree/{tag}/docs", "Changes": "blob/{tag}/CHANGELOG.md", "Issues": "issues", "Source": "tree/{tag}"}
LINK = re.compile(r"(!?)\[((?:[^\[\]]|!?\[[^\]]*\](?:\([^)]*\))?)*)\]\((?![a-z]+:|#)([^)\s]+)\)")


def absolute_links(text, repository, tag):
    """Markdown whose links to files of the repository are URLs: pages as GitHub and GitLab show them, pictures as the file itself."""

    def link(match):
        picture, words, target = match.groups()
        kind = "raw" if picture else "blob"
        return f"{picture}[{LINK.sub(link, words)}]({repository}/{kind}/{tag}/{target})"

    return LINK.sub(link, text)


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
