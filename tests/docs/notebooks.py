"""``make notebooks OUT=folder``: write the pages of the tutorials as notebooks, from the same sources as the site.

A page gives a notebook in Common Lisp, and one in Hy (``NAME-in-hy.ipynb``) if it has sessions in Hy. The sessions in that language become
cells, one for each thing that is typed; files become cells that write them. What is for those who learn the other language is left out. The
rest of the page stays text, commands of the shell, too. What is typed into the debugger is left out, and the cell before it, which fails, says so to Jupyter with the
tag ``raises-exception``. A task's code to begin with is a cell, and so is its check.

A package grows on the pages of the lectures, so their notebooks are in a folder of their own, and are run one after the other. The others
use the packages of ``tutorials``; those in plain Hy are copied beside them.
"""

from __future__ import annotations

import re
import shutil
import sys
from pathlib import Path

if __name__ == "__main__":
    sys.path.insert(0, str(Path(__file__).parents[2]))

from cramhy_runtime.course.parts import LANGUAGES, text_in  # noqa: E402
from cramhy_runtime.course.reading import tasks_in  # noqa: E402
from cramhy_runtime.course.steps import ERROR  # noqa: E402
from tests.docs.pages import COURSE, DOCS, FENCE, LECTURES, Block, Page, exchanges  # noqa: E402

TUTORIALS = DOCS / "tutorials"
PAGES = [TUTORIALS / name for name in LECTURES]
"""The pages of the lectures, in their order."""
MORE = [path for path in sorted(TUTORIALS.rglob("*.md")) if path not in PAGES and Page(path).texts("session")]
"""The other pages of the tutorials, the kitchen's too. Each can be run by itself."""
IN_HY = [path for path in PAGES + MORE if Page(path).texts("hy session")]
"""The pages that give a notebook in Hy, too."""
PACKAGES = {"lectures": [], "turtle": ["turtlesim_in_hy"], "kitchen": ["kitchen/kitchen_in_hy"]}
"""The folders of notebooks, and the packages in plain Hy that are copied into each."""
IN_DEBUGGER = re.compile(r"^\d+\] ")
COMMAND = re.compile(r"^ros\w+ ")


CHECK = "check"
"""The language of a block that `with_checks` has put there."""


def with_checks(text):
    """The text of a page with a block of the language `CHECK` in place of the comment of each task, behind the task's text."""
    found, end = "", 0
    for match, after in tasks_in(text):
        body = text[match.end("comment") : after]
        found += f"{text[end : match.start('comment')]}{body}\n```{CHECK}\n{match['name']}\n```\n"
        end = after
    return found + text[end:]


def parts(text):
    """Pieces of a page: texts, and `Block`s of code in their places."""
    text, end = with_checks(text), 0
    for match in FENCE.finditer(text):
        yield text[end : match.start()]
        yield Block(match[1], match[2] or None, match[3])
        end = match.end()
    yield text[end:]


def cells(text, language="lisp"):
    """(kind, text, fails) of each cell of a page; kind: ``"markdown"`` or ``"code"``. language: ``"lisp"`` or ``"hy"``."""
    sessions = "session" if language == "lisp" else "hy session"
    found = [] if language == "lisp" else [["code", "(in-hy)", False]]
    for part in parts(text):
        if isinstance(part, str):
            found.append(["markdown", f"{part[: len(part) - len(part.lstrip())]}{text_in(part, language)}\n\n", False])
        elif part.language in LANGUAGES and part.language != language or part.language == "xml" and language != "lisp":
            pass
        elif part.language == CHECK:
            task = part.text.strip()
            in_hy = f'(import cramhy-runtime.course.package [check])\n(check "{task}" "hy")'
            found.append(["code", in_hy if language == "hy" else f'(course:check "{task}")', False])
        elif part.kind == "start":
            if part.language == language:
                found.append(["code", part.text, False])
        elif part.kind == "file" and part.language in ("lisp", "xml", "hy"):
            found.append(["code", f"%%writefile {part.title}\n{part.text}", False])
        elif part.kind == sessions:
            for typed, whole in exchanges(part.text):
                if IN_DEBUGGER.match(whole):
                    if found and found[-1][0] == "code":
                        found[-1][2] = True
                elif COMMAND.match(typed):
                    found.append(["markdown", f"```\n{typed}\n```\n", False])
                else:
                    indent = "\n" + " " * whole.index(typed)  # below the prompt, which a cell has not
                    found.append(["code", typed.replace(indent, "\n"), any(line.startswith(ERROR) for line in whole.splitlines())])
        else:
            found.append(["markdown", f"```{part.language}\n{part.text}```\n", False])
    joined = []
    for kind, content, fails in found:
        if kind == "markdown" and joined and joined[-1][0] == "markdown":
            joined[-1][1] += content
        else:
            joined.append([kind, content, fails])
    return [(kind, content.strip("\n"), fails) for kind, content, fails in joined if content.strip()]


def notebook(page, language="lisp"):
    """The notebook, an `nbformat.NotebookNode`, of the page at a path, in ``language``."""
    import nbformat.v4 as made

    from cramhy_runtime.jupyter import kernelspec

    written = []
    for number, (kind, content, fails) in enumerate(cells(Path(page).read_text(encoding="utf-8"), language)):
        cell = made.new_markdown_cell(content) if kind == "markdown" else made.new_code_cell(content)
        cell["id"] = f"{Path(page).stem}-{number}"
        if fails:
            cell["metadata"]["tags"] = ["raises-exception"]
        written.append(cell)
    spec = {"name": kernelspec.NAME, "display_name": kernelspec.SHOWN, "language": "common-lisp"}
    return made.new_notebook(cells=written, metadata={"kernelspec": spec, "language_info": {"name": "common-lisp"}})


def folder_of(page):
    """The name of the folder of a page's notebooks, of those in `PACKAGES`."""
    return "lectures" if page in PAGES else "kitchen" if page.parent.name == "kitchen" else "turtle"


def prepare(folder, page):
    """Make ``folder``, and copy into it the packages that the notebooks of ``page`` import."""
    Path(folder).mkdir(parents=True, exist_ok=True)
    for name in PACKAGES[folder_of(page)]:
        copied = Path(folder) / Path(name).name
        shutil.copytree(COURSE / name, copied, ignore=shutil.ignore_patterns("__pycache__"), dirs_exist_ok=True)


def write(folder):
    """Write the notebooks into folders below ``folder``, and return their paths."""
    import nbformat

    paths = []
    for language, pages, ending in (("lisp", PAGES + MORE, ""), ("hy", IN_HY, "-in-hy")):
        for page in pages:
            place = Path(folder) / folder_of(page)
            prepare(place, page)
            paths.append(place / f"{page.stem}{ending}.ipynb")
            nbformat.write(notebook(page, language), paths[-1])
    return paths


if __name__ == "__main__":
    for path in write(sys.argv[1] if len(sys.argv) > 1 else "notebooks"):
        print(path)
