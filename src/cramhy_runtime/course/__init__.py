"""The course: pages of the tutorials as text, code to type and tasks, for the terminal (``cramhy learn``), a browser and notebooks.

    from cramhy_runtime import course

    course.as_json()                          # all pages as plain data, with HTML (`web`)
    course.check("rectangle", session)        # {"passed": True, "told": ["Well done: this task is solved."]}

Where the parts are: `contents` (which pages there are), `parts` (what a page is made of), `reading` (takes the Markdown apart),
`checking` (whether a task is solved), `typed_forms` (what was typed for it), `rules`, `bodies`, `plan_places`, `trees` (what is said
of slips in facts and rules, of forgotten parentheses, of ``top-level`` in the wrong place; typed text as lists), `package` (the same for
Lisp), `web` (for a page in a browser) · `learn`, `guide`, `commands`, `asked`, `steps`, `shown`, `files`, `progress`, `slips`, `mistyped`,
`other_packages`, `replay` (``cramhy learn``: the prompt, the way through a page, its commands, values that the debugger asks for, where it
is cut, text for a terminal, the student's files, how far somebody is, what is said of mistakes, of slips of writing and of functions of
other packages, what was typed in earlier sessions).
"""

from .checking import check, task
from .reading import PageError, page, pages
from .web import as_json

__all__ = ["as_json", "check", "page", "pages", "PageError", "task"]
