"""The pages of the course as plain data with HTML, for the page in a browser. It needs the package ``markdown``, where a site is made."""

from __future__ import annotations

import base64
import html
import mimetypes
import re

from cramhy_runtime.extras import install_command
from cramhy_runtime.kernel.typing_names import Any

from . import contents
from .parts import LANGUAGES, OF_BOTH, Code, File, Task, Typed, by_language
from .reading import pages

_LINK = re.compile(r"(?<!!)\[((?:[^\[\]]|!\[[^\]]*\]\([^)]*\))*)\]\((?![a-z]+:)[^)]*\)")
_PICTURE = re.compile(r"!\[([^\]]*)\]\(([^)]+)\)")


def as_json() -> dict[str, Any]:
    """All pages for a browser's tab, without those `contents.WITH_ROBOT`, as data that `json` can write::

        {"pages": [{"name", "title", "parts": [
            {"kind": "text", "html"}
            {"kind": "code", "lisp", "hy", "answer", "answer_hy"}
            {"kind": "file", "lisp": {"name", "text"}, "hy": {"name", "text"}}
            {"kind": "task", "name", "title", "html", "start": {"lisp", "hy"}, "hints": [html, ...]}]}]}

    A part of code is what is typed at once, and what is answered; an empty text where there is nothing in a language. A file may be
    ``None`` in a language. Text for one language is in ``<div data-only="lisp">`` or ``"hy"``. Pictures are inside
    of the HTML. Links to other pages of the documentation are plain words.
    """
    return {
        "pages": [
            {"name": page.name, "title": page.title, "parts": [data for part in page.parts for data in _data(part)]}
            for page in pages()
            if page.name not in contents.WITH_ROBOT
        ]
    }


def _data(part):
    if isinstance(part, Code):
        return list(_code(part))
    if isinstance(part, File):
        return [{"kind": "file", **{language: _file(getattr(part, language)) for language in LANGUAGES}}]
    if isinstance(part, Task):
        start = {language: part.start.get(language, "") for language in LANGUAGES}
        hints = [as_html(hint) for hint in part.hints]
        return [{"kind": "task", "name": part.name, "title": part.title, "html": as_html(part.markdown), "start": start, "hints": hints}]
    return [{"kind": "text", "html": as_html(part.markdown)}]


def _code(part):
    """One piece for each form: of both languages, if they have as many, and else of one."""
    none = Typed("", "", "")
    if len(part.lisp) == len(part.hy):
        pieces = list(zip(part.lisp, part.hy))
    else:
        pieces = [*((each, none) for each in part.lisp), *((none, each) for each in part.hy)]
    for lisp, hy in pieces:
        yield {"kind": "code", "lisp": lisp.text, "hy": hy.text, "answer": lisp.answer, "answer_hy": hy.answer}


def _file(file):
    return None if file is None else {"name": file[0], "text": file[1]}


def as_html(text: str) -> str:
    """Markdown of a page as HTML."""
    try:
        import markdown
    except ImportError:
        raise ImportError(f"The pages of the course become HTML with the package markdown. {install_command('web')}") from None
    pieces = []
    for language, piece in by_language(text):
        piece = _PICTURE.sub(_picture, _LINK.sub(r"\1", re.sub(r"<!--.*?-->\n?", "", piece, flags=re.S)))
        piece = OF_BOTH.sub(r'<span data-only="lisp">\g<lisp></span><span data-only="hy">\g<hy></span>', piece)
        piece = markdown.markdown(piece, extensions=["tables", "fenced_code"])
        pieces.append(piece if language is None else f'<div data-only="{language}">{piece}</div>')
    return "\n".join(pieces)


def _picture(match):
    file = contents.folder() / match[2]
    if not file.is_file():
        return match[1]
    kind = mimetypes.guess_type(file.name)[0] or "image/png"
    data = base64.b64encode(file.read_bytes()).decode()
    return f'<img alt="{html.escape(match[1])}" src="data:{kind};base64,{data}">'
