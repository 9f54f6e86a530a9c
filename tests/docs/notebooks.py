"""``make notebooks OUT=folder``: write the pages of the tutorial as notebooks, from the same sources as the site.

The sessions in Common Lisp on a page become cells, one for each thing that is typed; files become cells that write them. The rest of the page
stays text, Hy and commands of the shell, too. What is typed into the debugger is left out, and the cell before it, which fails, says so to
Jupyter with the tag ``raises-exception``.
"""

from __future__ import annotations

import re
import sys
from pathlib import Path

if __name__ == "__main__":
    sys.path.insert(0, str(Path(__file__).parents[2]))

from tests.docs.pages import FENCE, LECTURES, ROOT, Block, exchanges  # noqa: E402

TUTORIALS = ROOT / "docs" / "tutorials"
PAGES = [TUTORIALS / name for name in LECTURES]
"""The pages of the lectures, in their order: a package grows on them, so their notebooks are run in one folder."""
IN_DEBUGGER = re.compile(r"^\d+\] ")
COMMAND = re.compile(r"^ros\w+ ")


def parts(text):
    """Pieces of a page: texts, and `Block`s of code in their places."""
    end = 0
    for match in FENCE.finditer(text):
        yield text[end : match.start()]
        yield Block(match[1], match[2] or None, match[3])
        end = match.end()
    yield text[end:]


def cells(text):
    """(kind, text, fails) of each cell of a page; kind: ``"markdown"`` or ``"code"``."""
    found = []
    for part in parts(text):
        if isinstance(part, str):
            found.append(["markdown", part, False])
        elif part.kind == "file" and part.language in ("lisp", "xml", "hy"):
            found.append(["code", f"%%writefile {part.title}\n{part.text}", False])
        elif part.kind == "session":
            for typed, whole in exchanges(part.text):
                if IN_DEBUGGER.match(whole):
                    if found and found[-1][0] == "code":
                        found[-1][2] = True
                elif COMMAND.match(typed):
                    found.append(["markdown", f"```\n{typed}\n```\n", False])
                else:
                    found.append(["code", typed, "debugger invoked" in whole])
        else:
            found.append(["markdown", f"```{part.language}\n{part.text}```\n", False])
    joined = []
    for kind, content, fails in found:
        if kind == "markdown" and joined and joined[-1][0] == "markdown":
            joined[-1][1] += content
        else:
            joined.append([kind, content, fails])
    return [(kind, content.strip("\n"), fails) for kind, content, fails in joined if content.strip()]


def notebook(page):
    """The notebook, an `nbformat.NotebookNode`, of the page at a path."""
    import nbformat.v4 as made

    from cramhy_runtime.jupyter import kernelspec

    written = []
    for number, (kind, content, fails) in enumerate(cells(Path(page).read_text(encoding="utf-8"))):
        cell = made.new_markdown_cell(content) if kind == "markdown" else made.new_code_cell(content)
        cell["id"] = f"{Path(page).stem}-{number}"
        if fails:
            cell["metadata"]["tags"] = ["raises-exception"]
        written.append(cell)
    spec = {"name": kernelspec.NAME, "display_name": kernelspec.SHOWN, "language": "common-lisp"}
    return made.new_notebook(cells=written, metadata={"kernelspec": spec, "language_info": {"name": "common-lisp"}})


def write(folder):
    """Write the notebooks into ``folder``, and return their paths."""
    import nbformat

    folder = Path(folder)
    folder.mkdir(parents=True, exist_ok=True)
    paths = [folder / f"{page.stem}.ipynb" for page in PAGES]
    for page, path in zip(PAGES, paths):
        nbformat.write(notebook(page), path)
    return paths


if __name__ == "__main__":
    for path in write(sys.argv[1] if len(sys.argv) > 1 else "notebooks"):
        print(path)
